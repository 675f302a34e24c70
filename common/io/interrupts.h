// Ctrl-C and the like, which end a program at any time: nothing unfinished is left behind.
#pragma once

#include <string>

namespace rlpc {

// First of all in main(), before there are other threads. SIGINT, SIGTERM and SIGHUP then end
// the process by themselves, but once everything on the list below is removed; a second one
// does not wait for that. One that is ignored, as under nohup, stays so. SIGXFSZ is ignored: a
// limit to the size of files is an error of write(), as a full disk is.
void handle_interrupts();

// What an interrupt removes: files, and folders with all that is in them.
void add_unfinished(const std::string& path);
void remove_unfinished(const std::string& path);  // from the list

// While there is one, interrupts wait: for steps that belong together. They nest.
class HoldInterrupts {
 public:
  HoldInterrupts();
  HoldInterrupts(const HoldInterrupts&) = delete;
  HoldInterrupts& operator=(const HoldInterrupts&) = delete;
  ~HoldInterrupts();
};

}  // namespace rlpc
