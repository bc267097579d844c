// Definitions of surefoot/diagnose/residual_model.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/residual_model.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/serialize.hpp"

namespace surefoot {

namespace detail {

inline constexpr FileFormat residual_format{"SUREFRES", 1, "a residual model"};

}  // namespace detail

SUREFOOT_ONCE void save_residual_model(const ResidualModel& model, const std::string& path) {
  ByteWriter out;
  write_format(out, detail::residual_format);
  out.u32(static_cast<std::uint32_t>(model.features.size()));
  out.u32(static_cast<std::uint32_t>(model.outputs.size()));
  for (const std::string& name : model.features) out.text(name);
  for (const std::string& name : model.outputs) out.text(name);
  for (const double scale : model.scale) out.f64(scale);
  write(out, model.forest);
  out.add_checksum();
  write_file_atomically(path, out.bytes());
}

SUREFOOT_ONCE ResidualModel load_residual_model(const std::string& path) {
  const Bytes bytes = read_file(path);
  ByteReader in(bytes, "file " + path);
  expect_format(in, detail::residual_format);
  const std::uint32_t features = in.u32(), outputs = in.u32();
  ResidualModel model;
  for (std::uint32_t i = 0; i < features; ++i) model.features.push_back(in.text());
  for (std::uint32_t i = 0; i < outputs; ++i) model.outputs.push_back(in.text());
  std::vector<double> scales;
  for (std::uint32_t i = 0; i < outputs; ++i) scales.push_back(in.f64());
  model.scale.resize(static_cast<Eigen::Index>(outputs));
  std::copy(scales.begin(), scales.end(), model.scale.data());
  if (!all_finite(model.scale)) in.fail("has a scale that is not finite");
  model.forest = read<ResidualForest>(in);
  in.expect_checksum();
  in.expect_end();
  if (model.forest.inputs() != static_cast<int>(features) || model.forest.outputs() != static_cast<int>(outputs) ||
      model.forest.empty()) {
    in.fail("has a forest that does not go with its names");
  }
  return model;
}

}  // namespace surefoot
