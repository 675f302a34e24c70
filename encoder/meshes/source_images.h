// The images of the input: which are kept, and how.
#pragma once

#include <string>

namespace rlpc {

enum class Images {
  kNone,     // left out
  kSmaller,  // kept, with the bytes that smaller_png() returns
  kExact,    // kept with their bytes
};

// Returns a PNG image with the same scanlines and the same other chunks, deflated by zlib at
// its best level. Many programs write images fast rather than small.
//
// Returns the bytes as they are if that does not save any in a stream, which deflates the asset
// as well; and if they are no PNG image, or one that breaks the rules of its format anywhere,
// or one whose scanlines take more than 2^28 bytes.
//
// Takes 1 s per 15 MB of scanlines where it is worth it, and a tenth of that where it is not:
// a part in the middle is deflated first. Memory: two more images, and 1 MB.
std::string smaller_png(std::string bytes);

}  // namespace rlpc
