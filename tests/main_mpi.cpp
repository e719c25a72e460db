// Starts MPI once for all tests of an executable.
#include "sabot/base/mpi_session.h"

#include <gtest/gtest.h>

int main(int argc, char **argv)
{
  const sabot::MpiSession mpi(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
