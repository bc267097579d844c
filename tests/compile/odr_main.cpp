// Links only if no header defines anything twice.
#include "surefoot/surefoot.hpp"

double other_draw();

int main() { return other_draw() == surefoot::Rng(1).uniform() ? 0 : 1; }
