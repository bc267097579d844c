// Training on many processes with the calibrated walk.
#include "../train.hpp"
#include "surefoot/mpi/mpi_executor.hpp"

namespace sigmaban {

template void train(const CalibratedApproach&, const TrainOptions&, const surefoot::MpiExecutor&);

}  // namespace sigmaban
