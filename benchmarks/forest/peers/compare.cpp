// One table for every number of trees and leaves: training, error, size and speed of each library's forests on the same
// data.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "measure.hpp"
#include "method.hpp"
#include "samples.hpp"

namespace {

using namespace peers;

struct Options {
  std::vector<int> leaves = {200, 2'000, 20'000};
  std::size_t samples = 0;
  std::vector<int> trees = {25};
  std::size_t rounds = 7;
  std::size_t cold_calls = 50;
  std::vector<std::string> only;
  std::vector<std::string> without;
  std::vector<std::size_t> outputs = {1, 3};
  std::string csv;

  bool asks_for(const Method& method, int trees_wanted, int leaves_wanted) const {
    const auto named = [&](const std::string& part) { return method.name.find(part) != std::string::npos; };
    if (!only.empty() && std::ranges::none_of(only, named)) return false;
    if (std::ranges::any_of(without, named)) return false;
    if (method.one_tree && trees_wanted != trees.back()) return false;  // once is enough
    if (method.most_leaves > 0 && leaves_wanted > method.most_leaves) return false;
    return std::ranges::find(outputs, method.outputs) != outputs.end();
  }
};

struct Row {
  Method method;
  std::unique_ptr<Model> model;
  double training = 0;  // [s] of CPU time
  double explained = 0;
  std::vector<Latency> rounds;
};

std::vector<Row> train_all(const Options& options, std::size_t count, int trees, int leaves) {
  std::map<std::size_t, Samples> samples;
  std::map<std::size_t, Samples> tests;
  for (const std::size_t outputs : options.outputs) {
    samples[outputs] = make_samples(outputs, count, 1);
    tests[outputs] = make_samples(outputs, 20'000, 2);
  }
  std::vector<Row> rows;
  for (const Method& method : all_methods()) {
    if (!options.asks_for(method, trees, leaves)) continue;
    const Samples& data = samples[method.outputs];
    const Size size = size_for(method, data, trees, leaves);
    const double start = cpu_seconds();
    Row row{method, train(method, data, size), 0, 0, {}};
    row.training = cpu_seconds() - start;
    row.explained = explained(*row.model, tests[method.outputs]);
    rows.push_back(std::move(row));
    std::fprintf(stderr, "trained %s, %zu outputs, %d leaves: %.2f s\n", method.name.c_str(), method.outputs, leaves,
                 rows.back().training);
  }
  return rows;
}

void measure_all(std::vector<Row>& rows, const Options& options) {
  constexpr std::size_t points = 4096;
  const std::vector<float> x = make_samples(1, points, 3).x;
  Evictor evict;
  for (std::size_t round = 0; round < options.rounds; ++round) {
    for (Row& row : rows) row.rounds.push_back(measure(*row.model, x, evict, options.cold_calls, round));
  }
}

void print(const std::vector<Row>& rows, std::size_t count, int trees, int leaves, std::ofstream& csv) {
  std::map<std::size_t, Latency> dlib;  // by outputs
  for (const Row& row : rows) {
    if (row.method.name == "dlib") dlib[row.method.outputs] = median(row.rounds);
  }
  std::printf(
      "\n%d trees, %d leaves each, %zu samples; ns per prediction, in brackets how many times faster than dlib\n",
      trees, leaves, count);
  std::printf("%-28s %3s %7s %9s %7s  %8s %7s  %8s %7s  %8s %7s  %10s\n", "", "out", "leaves", "train s", "R2", "warm",
              "", "cold", "", "batch", "", "bytes");
  for (const Row& row : rows) {
    const Latency latency = median(row.rounds);
    const auto ratio = [&](double Latency::* field) {
      const auto peer = dlib.find(row.method.outputs);
      if (peer == dlib.end()) return std::string();
      char text[16];
      std::snprintf(text, sizeof text, "(%.2f)", peer->second.*field / latency.*field);
      return std::string(text);
    };
    std::printf("%-28s %3zu %7.0f %9.3f %7.4f  %8.0f %7s  %8.0f %7s  %8.0f %7s  %10zu\n", row.method.name.c_str(),
                row.method.outputs, row.model->leaves(), row.training, row.explained, latency.warm,
                ratio(&Latency::warm).c_str(), latency.cold, ratio(&Latency::cold).c_str(), latency.batch,
                ratio(&Latency::batch).c_str(), row.model->bytes());
    csv << row.method.name << ';' << row.method.outputs << ';' << leaves << ';' << row.model->leaves() << ';'
        << row.training << ';' << row.explained << ';' << latency.warm << ';' << latency.cold << ';' << latency.batch
        << ';' << row.model->bytes() << ';' << (row.method.one_tree ? 1 : trees) << '\n';
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Forests of several libraries on the same data");
  app.add_option("--leaves", options.leaves, "leaves per tree, one table each")->delimiter(',')->capture_default_str();
  app.add_option("--samples", options.samples, "to learn from; 0: 10000 and 7 more per leaf")->capture_default_str();
  app.add_option("--trees", options.trees, "per forest")->delimiter(',')->capture_default_str();
  app.add_option("--rounds", options.rounds, "of measurements, one library after the other")->capture_default_str();
  app.add_option("--cold-calls", options.cold_calls, "per round")->capture_default_str();
  app.add_option("--only", options.only, "rows whose name contains one of these")->delimiter(';');
  app.add_option("--without", options.without, "rows whose name contains none of these")->delimiter(';');
  app.add_option("--outputs", options.outputs, "rows with so many outputs")->delimiter(',')->capture_default_str();
  app.add_option("--csv", options.csv, "file for the same numbers");
  CLI11_PARSE(app, argc, argv);

  std::ofstream csv(options.csv);
  csv << "name;outputs;wanted leaves;leaves;training [s];R2;warm [ns];cold [ns];batch [ns];bytes;trees\n";
  std::printf("cold: %.0f MiB walked before each call\n", static_cast<double>(Evictor().bytes()) / 1048576);
  for (const int trees : options.trees) {
    for (const int leaves : options.leaves) {
      const std::size_t count = options.samples != 0 ? options.samples : 10'000 + 7 * static_cast<std::size_t>(leaves);
      std::vector<Row> rows = train_all(options, count, trees, leaves);
      measure_all(rows, options);
      print(rows, count, trees, leaves, csv);
    }
  }
}
