// `train`: RFPI from the states that Winner2016 visits, on the threads of one process or on many processes.
#pragma once

#include <cstddef>
#include <functional>

#include "motion.hpp"
#include "surefoot/core/any_executor.hpp"
#include "train_options.hpp"

namespace sigmaban {

/// Trains, writes policy and record. Defined in train_problem.hpp, for both problems in files of their own: each is all
/// of RFPI.
template <class Problem>
void train(const Problem& problem, const TrainOptions& options, const surefoot::AnyExecutor& executor);
extern template void train(const Approach&, const TrainOptions&, const surefoot::AnyExecutor&);
extern template void train(const CalibratedApproach&, const TrainOptions&, const surefoot::AnyExecutor&);

/// Trains on the executor that make_executor(options) gives, as a std::unique_ptr.
template <class MakeExecutor>
void train_on(const TrainOptions& options, MakeExecutor&& make_executor) {
  with_problem(options.problem, options.motion,
               [&](const auto& problem) { train(problem, options, surefoot::AnyExecutor(make_executor(options))); });
}

/// Adds the subcommand; `work(options)` trains. `threads`: the default.
void add_train_by(example::Command& program, std::size_t threads, std::function<void(const TrainOptions&)> work);

}  // namespace sigmaban
