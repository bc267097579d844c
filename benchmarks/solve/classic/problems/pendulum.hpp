// Pendulum-v1 of Gymnasium: a motor too weak to lift the pendulum at once.
#pragma once

#include "../references/value_iteration.hpp"
#include "tests/support/pendulum.hpp"

namespace classic {

struct Pendulum : surefoot::toy::Pendulum {
  static constexpr int evaluation_runs = 1000;

  Reference reference() const {
    return grid_reference(*this, {401, 201}, {true, false}, {{21}}, {.discount = 0.99, .sweeps = 500});
  }
};

}  // namespace classic
