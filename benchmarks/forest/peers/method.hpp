// The rows of the tables.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "model.hpp"

namespace peers {

struct Method {
  std::string name;
  std::size_t outputs = 1;
  Train train = nullptr;     // of one output or, if it can, of all
  bool each_output = false;  // a forest per output
  // Most samples per leaf to insist on where the number of leaves is the limit; 0: samples per leaf are the limit.
  int min_leaf = 0;
  bool balanced = false;  // see Size
  bool one_tree = false;  // however many trees are wanted
  int most_leaves = 0;    // per tree, with which it can be built in acceptable time; 0: no limit
};

/// Our own and those of the libraries that are installed.
std::vector<Method> all_methods();

/// Trees with as near to `leaves` leaves on average as the method can.
Size size_for(const Method& method, const Samples& samples, int trees, int leaves);

std::unique_ptr<Model> train(const Method& method, const Samples& samples, const Size& size);

}  // namespace peers
