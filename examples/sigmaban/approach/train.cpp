#include "train.hpp"

#include <memory>

#include "commands.hpp"
#include "surefoot/core/executor.hpp"

namespace sigmaban {

void add_train(CLI::App& program) {
  add_train_on(program, 0,
               [](const TrainOptions& options) { return std::make_unique<surefoot::Threads>(options.threads); });
}

}  // namespace sigmaban
