// Training: CPU time and error on 5k to 250k samples, against scikit-learn's extra-trees with as many leaves.
#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "measure.hpp"
#include "samples.hpp"
#include "surefoot.hpp"

namespace {

using namespace peers;

constexpr int trees = 25;
constexpr int min_leaf = 2;

struct Result {
  double seconds = 0;
  double explained = 0;
  double leaves = 0;
};

void write(const Samples& samples, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  for (std::size_t i = 0; i < samples.count(); ++i) {
    const auto y = static_cast<float>(samples.y[i]);
    out.write(reinterpret_cast<const char*>(&samples.x[i * inputs]), inputs * sizeof(float));
    out.write(reinterpret_cast<const char*>(&y), sizeof y);
  }
}

/// Empty if Python or the package is missing.
class Sklearn {
 public:
  Sklearn(std::string python, std::string script, const Samples& train, const Samples& test)
      : folder_(std::filesystem::temp_directory_path() / ("forest_training_" + std::to_string(train.count()))),
        command_(std::move(python) + " '" + std::move(script) + "' '" + (folder_ / "train").string() + "' '" +
                 (folder_ / "test").string() + "' " + std::to_string(inputs) + " " + std::to_string(trees) + " " +
                 std::to_string(min_leaf)) {
    std::filesystem::create_directories(folder_);
    write(train, folder_ / "train");
    write(test, folder_ / "test");
  }
  Sklearn(const Sklearn&) = delete;
  Sklearn& operator=(const Sklearn&) = delete;
  ~Sklearn() { std::filesystem::remove_all(folder_); }

  Result run() const {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command_.c_str(), "r"), pclose);
    Result result;
    if (!pipe || std::fscanf(pipe.get(), "%lf %lf %lf", &result.seconds, &result.explained, &result.leaves) != 3) {
      throw std::runtime_error("scikit-learn could not be run: " + command_);
    }
    return result;
  }

 private:
  std::filesystem::path folder_;
  std::string command_;
};

Result train(Train method, const Samples& samples, const Samples& test, const Size& size) {
  const double start = cpu_seconds();
  const auto model = method(samples, size);
  const double seconds = cpu_seconds() - start;
  return {seconds, explained(*model, test), model->leaves()};
}

Result median(const std::vector<Result>& rounds) {
  Result result = rounds.front();  // all but the time is the same in every round
  std::vector<double> seconds;
  for (const Result& round : rounds) seconds.push_back(round.seconds);
  result.seconds = peers::median(std::move(seconds));
  return result;
}

void print(std::size_t samples, const char* name, const Result& result, const Result& reference) {
  std::printf("%8zu  %-18s %9.3f %8.4f %9.0f %9.2f\n", samples, name, result.seconds, result.explained, result.leaves,
              result.seconds / reference.seconds);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::size_t> counts = {5'000, 50'000, 250'000};
  std::size_t rounds = 5;
  std::string python = "/usr/bin/python3";
  std::string script;
  CLI::App app("Training time of extra-trees against scikit-learn's");
  app.add_option("--samples", counts, "one comparison each")->delimiter(',')->capture_default_str();
  app.add_option("--rounds", rounds)->capture_default_str();
  app.add_option("--python", python, "that has scikit-learn")->capture_default_str();
  app.add_option("--script", script, "train_sklearn.py")->required();
  CLI11_PARSE(app, argc, argv);

  std::printf("%8s  %-18s %9s %8s %9s %9s\n", "samples", "", "CPU s", "R2", "leaves", "ratio");
  const Samples test = make_samples(1, 20'000, 2);
  for (const std::size_t count : counts) {
    const Samples samples = make_samples(1, count, 1);
    const Sklearn sklearn(python, script, samples, test);
    std::vector<Result> theirs, constant, linear;
    for (std::size_t round = 0; round < rounds; ++round) {
      theirs.push_back(sklearn.run());
      const int leaves = static_cast<int>(theirs[0].leaves);
      constant.push_back(train(train_constant, samples, test, {trees, leaves, min_leaf}));
      linear.push_back(train(train_linear, samples, test, {trees, 0, 20}));
    }
    const Result reference = median(theirs);
    print(count, "scikit-learn", reference, reference);
    print(count, "surefoot constant", median(constant), reference);
    print(count, "surefoot linear", median(linear), reference);
  }
}
