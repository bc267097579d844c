#include "surefoot/surefoot.hpp"

double other_draw() { return surefoot::Rng(1).uniform(); }
