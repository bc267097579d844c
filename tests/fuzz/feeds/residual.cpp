// A residual model that was loaded has a name for each input and output, and predicts.
#include "surefoot/diagnose/residual_model.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/mend_checksums.hpp"

void fuzz::residual(Input input) {
  using namespace surefoot;
  for (const Bytes& bytes : both_ways(input)) {
    const MemoryFile file(bytes);
    accepted<CoreError, ForestError>([&] {
      const ResidualModel model = load_residual_model(file.path());
      const auto inputs = static_cast<Eigen::Index>(model.features.size());
      const Eigen::VectorXd answer = model.forest.predict(Eigen::VectorXd::Ones(inputs));
      require(answer.size() == static_cast<Eigen::Index>(model.outputs.size()) && answer.allFinite(),
              "an answer that is none");
    });
  }
}
