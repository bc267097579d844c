// Every process runs every test. A failed REQUIRE in one process alone would leave the others waiting: it ends them.
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>

#include "surefoot/mpi/mpi_session.hpp"

int main(int argc, char** argv) {
  surefoot::MpiSession session(argc, argv);
  doctest::Context context(argc, argv);
  context.setOption("minimal", !session.first());
  context.setOption("no-path-filenames", true);
  const int failed = context.run();
  return session.end(failed, "");
}
