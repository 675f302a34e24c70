// Handles signals such as Ctrl-C: a program that they end removes its unfinished files.
#pragma once

#include <string>

namespace rlpc {

// Installs the handlers. Must be called first in main(), before starting threads. SIGINT,
// SIGTERM, SIGHUP, SIGQUIT, SIGXCPU and other signals that by default end a process then do so
// after removing everything on the list below; a second signal does not wait. Ignored signals,
// as under nohup, stay ignored. SIGXFSZ is ignored, and SIGPIPE noted: a file size limit and a
// closed pipe become errors of write(), like a full disk.
void handle_interrupts();

// Ends the process by SIGPIPE if one has been noted. Must be called when no file is unfinished.
void end_if_pipe_was_closed();

// Adds a file, or a folder with its contents, to the list that a signal removes.
void add_unfinished(const std::string& path);
void remove_unfinished(const std::string& path);  // removes it from the list, not the disk

// Delays signals during its lifetime, to make several steps atomic. May be nested.
class HoldInterrupts {
 public:
  HoldInterrupts();
  HoldInterrupts(const HoldInterrupts&) = delete;
  HoldInterrupts& operator=(const HoldInterrupts&) = delete;
  ~HoldInterrupts();
};

}  // namespace rlpc
