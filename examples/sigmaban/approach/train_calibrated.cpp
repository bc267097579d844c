// Training with the calibrated walk.
#include "train_problem.hpp"

namespace sigmaban {

template void train(const CalibratedApproach&, const TrainOptions&, const surefoot::AnyExecutor&);

}  // namespace sigmaban
