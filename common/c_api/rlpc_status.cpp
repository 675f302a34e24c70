#include "common/c_api/rlpc_status.h"

const char* rlpc_status_text(int status) {
  switch (status) {
    case RLPC_OK:
      return "done";
    case RLPC_END:
      return "no further frame";
    case RLPC_BAD_STREAM:
      return "not a conforming stream";
    case RLPC_UNSUPPORTED:
      return "not supported by this version";
    case RLPC_LIMIT_EXCEEDED:
      return "more than the limits allow";
    case RLPC_IO_FAILED:
      return "input or output failed";
    case RLPC_BAD_INPUT:
      return "cannot be encoded";
    case RLPC_BAD_ARGUMENT:
      return "wrong argument";
    case RLPC_OUT_OF_MEMORY:
      return "out of memory";
    case RLPC_INTERNAL_ERROR:
      return "internal error";
  }
  return "unknown status";
}

const char* rlpc_version() { return RLPC_VERSION; }
