// Where the files of a whole comparison lie in one folder: `train` and `tune` are told to write them there,
// `table` and `trajectories` read them.
#pragma once

#include <filesystem>
#include <string>

namespace sigmaban {

struct Results {
  std::filesystem::path folder;

  std::filesystem::path rfpi(const std::string& problem) const { return folder / ("rfpi_" + problem + ".policy"); }
  std::filesystem::path paper(const std::string& problem) const { return folder / ("paper_" + problem + ".policy"); }
  std::filesystem::path tuned(const std::string& problem) const { return folder / ("tuned_" + problem + ".json"); }
};

/// The record of a training, beside its policy file: options, history, cost.
inline std::filesystem::path record_of(const std::filesystem::path& policy) { return policy.string() + ".json"; }

}  // namespace sigmaban
