// Eigen with large temporaries on the heap: by default, it puts up to 128 KiB each on the
// stack, and the stack of a thread can be as small as that.
#pragma once

#define EIGEN_STACK_ALLOCATION_LIMIT 4096
#include <Eigen/Dense>
#include <Eigen/StdVector>
