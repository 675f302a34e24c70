// RLPC in C: what the functions of rlpc_decode.h and rlpc_encode.h return. C99 and C++.
#pragma once

#if defined(__GNUC__)
#define RLPC_API __attribute__((visibility("default")))
#else
#define RLPC_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): names as they are usual in C.
typedef enum rlpc_status {
  RLPC_OK = 0,
  RLPC_END = 1,             // no error: there is no further frame, and the stream was whole
  RLPC_BAD_STREAM = 2,      // not a conforming stream: damaged, or cut off
  RLPC_UNSUPPORTED = 3,     // of a later version
  RLPC_LIMIT_EXCEEDED = 4,  // beyond the limits of the options
  RLPC_IO_FAILED = 5,       // a file, or a callback of the caller
  RLPC_BAD_INPUT = 6,       // what is to be encoded, or the settings
  RLPC_BAD_ARGUMENT = 7,    // null, a wrong number of values, a frame that is not there
  RLPC_OUT_OF_MEMORY = 8,
  RLPC_INTERNAL_ERROR = 9,  // a bug
} rlpc_status;
// NOLINTEND(readability-identifier-naming)

// In a few words, for a status alone; handles have a text that says what, where and why. Never
// null, for any number.
RLPC_API const char* rlpc_status_text(int status);

// Of the library, such as "1.1.6".
RLPC_API const char* rlpc_version(void);

#ifdef __cplusplus
}
#endif
