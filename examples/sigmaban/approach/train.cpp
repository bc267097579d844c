#include "train.hpp"

#include <memory>

#include "commands.hpp"
#include "surefoot/core/executor.hpp"

namespace sigmaban {

void train_on_threads(const TrainOptions& options) {
  train_on(options, [](const TrainOptions& o) { return std::make_unique<surefoot::Threads>(o.threads); });
}

void add_train(CLI::App& program) { add_train_by(program, 0, train_on_threads); }

}  // namespace sigmaban
