// Eigen, with its temporaries in the heap where they are large: it puts up to 128 KiB each on
// the stack, and threads can have as little as that.
#pragma once

#define EIGEN_STACK_ALLOCATION_LIMIT 4096
#include <Eigen/Dense>
#include <Eigen/StdVector>
