// concealed_score: compares answers with the hidden truth of the cases and prints tables.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare.hpp"
#include "reliability.hpp"
#include "table.hpp"

namespace {

constexpr const char* usage =
    "usage: concealed_score --cases DIR --results [NAME=]DIR [--results [NAME=]DIR]... [--reliability FILE]\n"
    "DIR of --cases is what concealed_plants wrote (with truth/ in it or beside it); each results DIR holds\n"
    "case_0001/diagnosis.json and so on. Details are printed for the first results, one table column for each.\n"
    "--reliability FILE writes the first results' stated probabilities against shares right, for reliability.gp\n";

struct Method {
  std::string name;
  std::filesystem::path results;
};

struct Options {
  std::filesystem::path truth, reliability;
  std::vector<Method> methods;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i];
    if (i + 1 >= argc) throw std::invalid_argument(option + " needs a value");
    const std::string given = argv[i + 1];
    if (option == "--cases") {
      const std::filesystem::path folder = given;
      const auto beside = std::filesystem::absolute(folder / "").parent_path().parent_path() / "truth";
      options.truth = std::filesystem::is_directory(folder / "truth") ? folder / "truth" : beside;
      if (!std::filesystem::is_directory(options.truth))
        throw std::invalid_argument("no folder truth in or beside " + given);
    } else if (option == "--results") {
      const std::size_t equals = given.find('=');
      const std::filesystem::path folder = equals == std::string::npos ? given : given.substr(equals + 1);
      if (!std::filesystem::is_directory(folder)) throw std::invalid_argument("no folder " + folder.string());
      const auto last = std::filesystem::absolute(folder / "").parent_path().filename().string();
      options.methods.push_back({equals == std::string::npos ? last : given.substr(0, equals), folder});
    } else if (option == "--reliability") {
      options.reliability = given;
    } else {
      throw std::invalid_argument("unknown option " + option);
    }
  }
  if (options.truth.empty() || options.methods.empty()) throw std::invalid_argument("--cases and --results are needed");
  return options;
}

std::vector<score::Outcome> outcomes_of(const std::vector<score::Truth>& truths, const Method& method) {
  std::vector<score::Outcome> outcomes;
  for (const score::Truth& truth : truths) {
    const auto answer = score::read_answer(method.results / truth.name / "diagnosis.json");
    if (answer) outcomes.push_back(score::compare(truth, *answer));
  }
  return outcomes;
}

// Nothing where no probabilities are stated.
void write_reliability(const std::filesystem::path& file, const std::vector<score::Outcome>& outcomes) {
  const auto statements = score::statements_of(outcomes);
  if (file.empty() || statements.empty()) return;
  std::ofstream stream(file);
  stream << score::reliability_data(score::bins_of(statements));
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string() + ": is there space and permission?");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = parse(argc, argv);
    const std::vector<score::Truth> truths = score::read_truths(options.truth);
    std::vector<score::Summary> summaries;
    for (const Method& method : options.methods) {
      const std::vector<score::Outcome> outcomes = outcomes_of(truths, method);
      if (summaries.empty()) {
        score::print_details(outcomes);
        write_reliability(options.reliability, outcomes);
      }
      summaries.push_back(score::summarize(method.name, outcomes, truths.size()));
    }
    score::print_summaries(summaries);
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "concealed_score: %s\n%s", error.what(), usage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_score: %s\n", error.what());
    return 1;
  }
}
