# surefoot::mpi: the header mpi/mpi_executor.hpp and what it needs. On by default where surefoot itself is built, so that
# it is tested wherever MPI is installed; projects that include surefoot ask for it.
option(SUREFOOT_MPI "Build the target surefoot::mpi, if MPI is found" ${PROJECT_IS_TOP_LEVEL})
if(SUREFOOT_MPI)
  set(MPI_CXX_SKIP_MPICXX TRUE)  # the C functions only
  find_package(MPI QUIET COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    add_library(surefoot_mpi INTERFACE)
    add_library(surefoot::mpi ALIAS surefoot_mpi)
    target_link_libraries(surefoot_mpi INTERFACE surefoot MPI::MPI_CXX)
  else()
    message(STATUS "surefoot: surefoot::mpi and what uses it skipped, MPI not found (Debian: libopenmpi-dev openmpi-bin)")
  endif()
endif()
