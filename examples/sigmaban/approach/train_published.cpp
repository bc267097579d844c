// Training with the published walk.
#include "train_problem.hpp"

namespace sigmaban {

template void train(const Approach&, const TrainOptions&, const surefoot::AnyExecutor&);

}  // namespace sigmaban
