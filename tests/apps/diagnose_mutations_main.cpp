// Runs COUNT random mutations of model files and recordings (half each), for a build with sanitizers.
#include <cstdio>
#include <cstdlib>

#include "tests/apps/diagnose_mutations.hpp"

int main(int argc, char** argv) {
  using namespace diagnose_test;
  const long count = argc > 1 ? std::atol(argv[1]) : 10'000;
  surefoot::Rng rng(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  const auto layout = diagnose_program::layout_of(diagnose_program::parse_model_file(servo_model, "servo.toml"));
  MutationCounts models, recordings;
  for (long i = 0; i < count / 2; ++i) {
    try_model(damaged(i % 2 == 0 ? servo_model : walk_model, rng), models);
    try_recording(damaged(servo_csv, rng), layout, recordings);
  }
  std::printf("models: %zu read, %zu refused, %zu bad messages\n", models.read, models.refused, models.bad_messages);
  std::printf("recordings: %zu read, %zu refused, %zu bad messages\n", recordings.read, recordings.refused,
              recordings.bad_messages);
  if (!models.bad_message.empty()) std::printf("such as: %s\n", models.bad_message.c_str());
  return models.bad_messages + recordings.bad_messages == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
