// Trains, stops, resumes and exports with the program itself; budgets are tiny, the policies need not be good.
#include <dlfcn.h>
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "examples/sigmaban/approach/approach.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "tests/support/program.hpp"

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
    const auto compiled =
        run_command("cc -O2 -std=c99 -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -shared -fPIC -o " + library +
                    " " + c_file + " -lm");
    CAPTURE(compiled.output);
    REQUIRE(compiled.code == 0);
    library_ = dlopen(library.c_str(), RTLD_NOW);
    REQUIRE(library_ != nullptr);
    function_ = reinterpret_cast<Function>(dlsym(library_, "surefoot_policy"));
    REQUIRE(bool(function_ != nullptr));
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

/// Starts the program, waits until the shell's test `condition` holds, and sends the signal. The program must be
/// running until then.
approach_program::Outcome run_in_background(const std::string& arguments, const std::string& condition,
                                            const std::string& signal) {
  return run_command(program() + " " + arguments + " > /dev/null & pid=$!; until [ " + condition +
                     " ]; do kill -0 $pid || exit 99; sleep 0.02; done; kill -" + signal + " $pid; wait $pid");
}

void train(const std::string& arguments, const std::string& file) {
  const auto result = run("train --problem ha " + arguments + " --out " + file);
  CAPTURE(result.output);
  REQUIRE(result.code == 0);
}

}  // namespace

TEST_SUITE("sigmaban_approach" * doctest::skip(!program_exists())) {
  TEST_CASE("an exported policy acts as the library does, and a smaller one fits its limit") {
    const ScratchFolder folder;
    const std::string policy = folder.file("ha.policy"), c_file = folder.file("ha.c");
    train("--budget 0.3", policy);
    const Approach problem = Approach::ha();

    REQUIRE(run("export --policy " + policy + " --out " + c_file + " --max-kb 0").code == 0);
    CHECK(largest_difference(CPolicy(c_file), surefoot::load_policy(problem, policy), problem.state_box()) <= 1e-6);

    const auto smaller = run("export --policy " + policy + " --out " + c_file + " --max-kb 20 --runs 300 --trials 100");
    REQUIRE(smaller.code == 0);
    CHECK(smaller.output.find("the smaller size costs") != std::string::npos);
    CHECK(std::filesystem::file_size(c_file) <= 20'000);
    const auto distilled = surefoot::load_policy(problem, c_file + ".policy");
    CHECK(largest_difference(CPolicy(c_file), distilled, problem.state_box()) <= 1e-6);
  }

  TEST_CASE("a training that was killed and resumed gives the same policy as one in one go") {
    const ScratchFolder folder;
    const std::string whole = folder.file("whole"), parts = folder.file("parts");
    train("--budget 0.8 --threads 1", whole);
    const auto killed =
        run_in_background("train --problem ha --budget 0.8 --threads 2 --checkpoint-every 0 --out " + parts,
                          "-e " + parts + ".checkpoint", "KILL");
    REQUIRE(killed.code == 128 + 9);
    REQUIRE_FALSE(std::filesystem::exists(parts));
    train("--budget 0.8 --threads 2 --resume", parts);
    CHECK(surefoot::read_file(whole) == surefoot::read_file(parts));
  }

  TEST_CASE("Ctrl-C ends a training with code 130 and keeps the best policy so far") {
    const ScratchFolder folder;
    const std::string policy = folder.file("policy");
    const auto result = run_in_background("train --problem anha --budget 10000 --checkpoint-every 0 --out " + policy,
                                          "-e " + policy + ".checkpoint", "INT");
    CHECK(result.code == 130);
    CHECK(run("evaluate --problem anha --trials 10 --policy " + policy).code == 0);
    const auto wrong = run("evaluate --problem ha --trials 10 --policy " + policy);
    CHECK(wrong.code == 2);
    CHECK(wrong.output.find(policy) != std::string::npos);
  }

  TEST_CASE("tuned parameters are written with their cost and can be evaluated") {
    const ScratchFolder folder;
    const std::string file = folder.file("parameters.json");
    const auto tuned = run("tune --problem ha --budget 0.1 --out " + file);
    CAPTURE(tuned.output);
    REQUIRE(tuned.code == 0);
    CHECK(run("evaluate --problem ha --trials 100 --policy " + file).code == 0);
  }
}
