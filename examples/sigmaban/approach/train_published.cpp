// Training with the published walk.
#include "train.hpp"

namespace sigmaban {

template void train(const Approach&, const TrainOptions&, const surefoot::AnyExecutor&);

}  // namespace sigmaban
