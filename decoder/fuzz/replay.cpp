// Runs a fuzz target on files and mutations of them, without libFuzzer. Needed for the memory
// sanitizer: the runtime of libFuzzer contains uninstrumented functions of the standard
// library, which would replace the instrumented ones at link time.
//
//   TARGET [MUTATIONS] FILE...      mutations per file, default 0; deterministic

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" __attribute__((weak)) std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data,
                                                                     std::size_t size,
                                                                     std::size_t max_size,
                                                                     unsigned seed);

namespace {

std::minstd_rand numbers;

std::size_t below(std::size_t n) { return numbers() % n; }

std::vector<std::uint8_t> bytes_of(const char* path) {
  std::vector<std::uint8_t> bytes;
  std::FILE* const file = std::fopen(path, "rb");
  if (file == nullptr) {
    std::perror(path);
    std::exit(1);
  }
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    bytes.push_back(static_cast<std::uint8_t>(c));
  }
  std::fclose(file);
  return bytes;
}

void run(const std::vector<std::uint8_t>& bytes) {
  // An exact-size copy, so that sanitizers detect reads past its end.
  const std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
  LLVMFuzzerTestOneInput(input.data(), input.size());
}

}  // namespace

// Replaces the mutation of libFuzzer: changes, inserts or removes a byte.
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size) {
  const auto byte = static_cast<std::uint8_t>(below(256));
  const std::size_t at = below(size + 1);
  switch (below(4)) {
    case 0:
      if (size == max_size) return size;
      std::copy_backward(data + at, data + size, data + size + 1);
      data[at] = byte;
      return size + 1;
    case 1:
      if (at == size) return size;
      std::copy(data + at + 1, data + size, data + at);
      return size - 1;
    default:
      if (at < size) data[at] = byte;
      return size;
  }
}

int main(int argc, char** argv) {
  int first_file = 1;
  long mutations = 0;
  if (argc > 1) {
    char* end = nullptr;
    mutations = std::strtol(argv[1], &end, 10);
    if (*end == '\0') first_file = 2;
  }
  std::size_t inputs = 0;
  for (int i = first_file; i < argc; ++i) {
    const std::vector<std::uint8_t> bytes = bytes_of(argv[i]);
    run(bytes);
    ++inputs;
    std::vector<std::uint8_t> mutated;
    for (long m = 0; m < mutations; ++m, ++inputs) {
      mutated = bytes;
      mutated.resize(bytes.size() + 256);
      std::size_t size = bytes.size();
      if (LLVMFuzzerCustomMutator != nullptr) {
        size = LLVMFuzzerCustomMutator(mutated.data(), size, mutated.size(),
                                       static_cast<unsigned>(numbers()));
      } else {
        size = LLVMFuzzerMutate(mutated.data(), size, mutated.size());
      }
      mutated.resize(size);
      run(mutated);
    }
  }
  std::printf("%zu inputs of %d files\n", inputs, argc - first_file);
  return inputs == 0 ? 1 : 0;
}
