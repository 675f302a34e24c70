// RLPC in C: status codes of rlpc_c_decoder.h and rlpc_c_encoder.h. C99 and C++.
//
// Versions: "Since 1.2" is the version of the library that added a type, function, value or
// member; everything else is in all versions since the first with this interface, 1.1.2.
// Nothing is removed or changes its meaning before version 2.
//
// Structures: those that begin with struct_size may get further members, at their end only.
// struct_size is the size in the version of the caller, sizeof; an _init function sets it, or
// the call that fills the structure takes it. Members that an older caller does not know keep
// their defaults, and are not written. Members that an older library does not know are set to
// 0 by calls that fill a structure; where the caller has set one to another value, calls that
// read it return RLPC_BAD_ARGUMENT. Structures without struct_size never change.
//
// Threads: functions without a handle may be called by several threads at a time. A handle may
// be used by one thread at a time; different handles are independent.
#pragma once

// RLPC_API precedes each function. Programs that link a static library define RLPC_STATIC,
// which only Windows needs; CMake's targets and `pkg-config --static` do so. RLPC_BUILDING is
// defined while the shared library itself is built.
#if defined(RLPC_STATIC)
#define RLPC_API
#elif defined(_WIN32) && defined(RLPC_BUILDING)
#define RLPC_API __declspec(dllexport)
#elif defined(_WIN32)
#define RLPC_API __declspec(dllimport)
#elif defined(__GNUC__)
#define RLPC_API __attribute__((visibility("default")))
#else
#define RLPC_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
// Result of a call. Later versions may add values.
typedef enum rlpc_status {
  RLPC_OK = 0,
  RLPC_END = 1,             // not an error: no further frames, and the stream is complete
  RLPC_BAD_STREAM = 2,      // not a conforming stream: damaged or truncated
  RLPC_UNSUPPORTED = 3,     // a later version of the format, or a feature not built in
  RLPC_LIMIT_EXCEEDED = 4,  // limits of the options exceeded
  RLPC_IO_FAILED = 5,       // a file or a callback failed
  RLPC_BAD_INPUT = 6,       // invalid animation or settings
  RLPC_BAD_ARGUMENT = 7,    // null, wrong number of values, no such frame
  RLPC_OUT_OF_MEMORY = 8,
  RLPC_INTERNAL_ERROR = 9,  // a bug in the library
} rlpc_status;
// NOLINTEND(readability-identifier-naming)

// Returns a short text for a status, never null, even for unknown numbers; the error text of a
// handle has the details. The text is constant. status: a value of rlpc_status.
RLPC_API const char* rlpc_status_text(int status);

// Returns the version of the library, such as "1.2.0". The text is constant.
RLPC_API const char* rlpc_version(void);

#ifdef __cplusplus
}
#endif
