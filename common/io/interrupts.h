// Handling of signals such as Ctrl-C: a program that they end removes its unfinished files.
#pragma once

#include <string>

namespace rlpc {

// Call first in main(), before starting threads. SIGINT, SIGTERM and SIGHUP then end the
// process after removing everything on the list below; a second signal does not wait. Ignored
// signals, as under nohup, stay ignored. SIGXFSZ is ignored: a file size limit becomes an error
// of write(), like a full disk.
void handle_interrupts();

// Adds a file, or a folder with its contents, to the list that a signal removes.
void add_unfinished(const std::string& path);
void remove_unfinished(const std::string& path);  // takes it off the list

// Delays signals while it exists, to make several steps atomic. May be nested.
class HoldInterrupts {
 public:
  HoldInterrupts();
  HoldInterrupts(const HoldInterrupts&) = delete;
  HoldInterrupts& operator=(const HoldInterrupts&) = delete;
  ~HoldInterrupts();
};

}  // namespace rlpc
