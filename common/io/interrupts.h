// Signals such as Ctrl-C: a program that they end leaves nothing unfinished behind.
#pragma once

#include <string>

namespace rlpc {

// Call first in main(), before starting threads. SIGINT, SIGTERM and SIGHUP then end the
// process after removing everything on the list below; a second signal does not wait. Ignored
// signals, as under nohup, stay ignored. SIGXFSZ is ignored: a file size limit becomes an error
// of write(), like a full disk.
void handle_interrupts();

// The list of files, and folders with their contents, that a signal removes.
void add_unfinished(const std::string& path);
void remove_unfinished(const std::string& path);  // from the list

// Delays signals while it exists, for steps that belong together. Nests.
class HoldInterrupts {
 public:
  HoldInterrupts();
  HoldInterrupts(const HoldInterrupts&) = delete;
  HoldInterrupts& operator=(const HoldInterrupts&) = delete;
  ~HoldInterrupts();
};

}  // namespace rlpc
