// Fails unless a random number lies where it should.
#include "surefoot/core/rng.hpp"

int main() {
  const double number = surefoot::Rng(1).uniform(2, 3);
  return number >= 2 && number < 3 ? 0 : 1;
}
