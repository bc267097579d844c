// Trains, stops, resumes and exports with the program itself; budgets are tiny, the policies need not be good.
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "examples/sigmaban_approach/approach.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "tests/examples/program.hpp"

using approach_program::program;
using approach_program::program_exists;
using approach_program::run;
using approach_program::run_command;
using approach_program::ScratchFolder;
using sigmaban::Approach;

namespace {

/// The policy function of an exported C file, compiled as a robot's computer would.
class CPolicy {
 public:
  explicit CPolicy(const std::string& c_file) {
    const std::string library = c_file + ".so";
    const auto compiled = run_command("cc -O2 -std=c99 -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -shared -fPIC -o " +
                                      library + " " + c_file + " -lm");
    CAPTURE(compiled.output);
    REQUIRE(compiled.code == 0);
    library_ = dlopen(library.c_str(), RTLD_NOW);
    REQUIRE(library_ != nullptr);
    function_ = reinterpret_cast<Function>(dlsym(library_, "surefoot_policy"));
    REQUIRE(function_ != nullptr);
  }
  ~CPolicy() { dlclose(library_); }
  CPolicy(const CPolicy&) = delete;
  CPolicy& operator=(const CPolicy&) = delete;

  Approach::Action operator()(const Approach::State& state) const {
    Approach::Action action;
    function_(state.data(), action.data());
    return action;
  }

 private:
  using Function = void (*)(const double*, double*);
  void* library_ = nullptr;
  Function function_ = nullptr;
};

/// The largest difference of any action, over states from the whole box and its faces.
template <class A, class B>
double largest_difference(const A& a, const B& b, const surefoot::Box<6>& box) {
  double largest = 0;
  surefoot::Rng rng(1);
  for (int i = 0; i < 5000; ++i) {
    Approach::State state = box.sample(rng);
    if (i % 5 == 0) {
      for (double& number : state) number *= 3;
      state = box.clamp(state);
    }
    largest = std::max(largest, (a(state) - b(state)).cwiseAbs().maxCoeff());
  }
  return largest;
}

std::string train(const std::string& arguments, const std::string& file) {
  const auto result = run("train --problem ha " + arguments + " --out " + file);
  CAPTURE(result.output);
  REQUIRE(result.code == 0);
  return result.output;
}

}  // namespace

TEST_SUITE("sigmaban_approach" * doctest::skip(!program_exists())) {
  TEST_CASE("an exported policy acts as the library does, and a smaller one fits its limit") {
    const ScratchFolder folder;
    const std::string policy = folder.file("ha.policy"), c_file = folder.file("ha.c");
    train("--budget 0.5", policy);
    const Approach problem = Approach::ha();

    REQUIRE(run("export --policy " + policy + " --out " + c_file + " --max-kb 0").code == 0);
    CHECK(largest_difference(CPolicy(c_file), surefoot::load_policy(problem, policy), problem.state_box()) <= 1e-6);

    const auto smaller = run("export --policy " + policy + " --out " + c_file + " --max-kb 20");
    REQUIRE(smaller.code == 0);
    CHECK(smaller.output.find("the smaller size costs") != std::string::npos);
    CHECK(std::filesystem::file_size(c_file) <= 20'000);
    const auto distilled = surefoot::load_policy(problem, c_file + ".policy");
    CHECK(largest_difference(CPolicy(c_file), distilled, problem.state_box()) <= 1e-6);
  }

  TEST_CASE("a training that was killed and resumed gives the same policy as one in one go") {
    const ScratchFolder folder;
    const std::string whole = folder.file("whole"), parts = folder.file("parts");
    train("--budget 1.5 --threads 1", whole);
    train("--budget 0.7 --threads 2", parts);
    train("--budget 1.5 --threads 2 --resume", parts);
    CHECK(surefoot::read_file(whole) == surefoot::read_file(parts));
  }

  TEST_CASE("Ctrl-C ends a training with code 130 and keeps the best policy so far") {
    const ScratchFolder folder;
    const std::string policy = folder.file("policy"), log = folder.file("log");
    const auto result = run_command(program() + " train --problem anha --budget 10000 --out " + policy + " > " + log +
                                    " & pid=$!; until grep -q iteration " + log +
                                    "; do kill -0 $pid || exit 1; sleep 0.05; done; kill -INT $pid; wait $pid");
    CHECK(result.code == 130);
    CHECK(run("evaluate --problem anha --trials 10 --policy " + policy).code == 0);
    const auto wrong = run("evaluate --problem ha --trials 10 --policy " + policy);
    CHECK(wrong.code == 2);
    CHECK(wrong.output.find(policy) != std::string::npos);
  }

  TEST_CASE("tuned parameters are written with their cost and can be evaluated") {
    const ScratchFolder folder;
    const std::string file = folder.file("parameters.json");
    const auto tuned = run("tune --problem ha --runs 20000 --out " + file);
    CAPTURE(tuned.output);
    REQUIRE(tuned.code == 0);
    CHECK(run("evaluate --problem ha --trials 100 --policy " + file).code == 0);
  }
}
