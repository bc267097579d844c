// What a forest says at 25 states, to the last bit.
#pragma once

#include <cstdio>

#include "middle_leaf.hpp"

inline bool write_answers(const TorqueForest& forest, const char* path) {
  std::FILE* file = std::fopen(path, "w");
  if (file == nullptr) return false;
  for (int i = 0; i < 25; ++i) {
    const surefoot::Vec<2> state(-1 + 0.5 * (i % 5), -2 + i / 5);
    std::fprintf(file, "%a\n", forest.predict(state)[0]);
  }
  return std::fclose(file) == 0;
}
