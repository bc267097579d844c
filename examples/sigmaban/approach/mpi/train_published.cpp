// Training on many processes with the published walk.
#include "../train.hpp"
#include "surefoot/mpi/mpi_executor.hpp"

namespace sigmaban {

template void train(const Approach&, const TrainOptions&, const surefoot::MpiExecutor&);

}  // namespace sigmaban
