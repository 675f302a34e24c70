#include "common/files/interrupts.h"

#include <pthread.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace rlpc {
namespace {

struct Unfinished {
  std::recursive_mutex mutex;
  std::vector<std::string> paths;
};

// Never destroyed, because a signal may arrive while the process ends.
Unfinished& unfinished() {
  static auto& list = *new Unfinished;
  return list;
}

// Signals to a process that by default end it.
constexpr std::array kEnding{SIGINT,  SIGTERM, SIGHUP,    SIGQUIT, SIGXCPU,
                             SIGALRM, SIGPROF, SIGVTALRM, SIGUSR1, SIGUSR2};

volatile std::sig_atomic_t pipe_was_closed = 0;

void note_closed_pipe(int /*signal*/) { pipe_was_closed = 1; }

bool is_ignored(int signal) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

[[noreturn]] void end_by(int signal, const sigset_t& signals) {
  for (const int other : kEnding) {
    if (sigismember(&signals, other) == 1) std::signal(other, SIG_DFL);
  }
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  unfinished().mutex.lock();  // never unlocked: no new file may be added
  for (const std::string& path : unfinished().paths) {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::raise(signal);
  std::abort();  // not reached: the default action of these signals ends the process
}

}  // namespace

void handle_interrupts() {
  std::signal(SIGXFSZ, SIG_IGN);
  if (!is_ignored(SIGPIPE)) {
    struct sigaction note {};
    note.sa_handler = note_closed_pipe;
    note.sa_flags = SA_RESTART;
    sigaction(SIGPIPE, &note, nullptr);
  }
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : kEnding) {
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  }
  // A thread handles the signals, as signal handlers must not remove files.
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  try {
    std::thread([signals] {
      int signal = 0;
      while (sigwait(&signals, &signal) != 0) {
      }
      end_by(signal, signals);
    }).detach();
  } catch (const std::system_error&) {  // no thread available
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  }
}

void end_if_pipe_was_closed() {
  if (pipe_was_closed == 0) return;
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
}

void add_unfinished(const std::string& path) {
  const HoldInterrupts hold;
  unfinished().paths.push_back(path);
}

void remove_unfinished(const std::string& path) {
  const HoldInterrupts hold;
  std::erase(unfinished().paths, path);
}

HoldInterrupts::HoldInterrupts() { unfinished().mutex.lock(); }
HoldInterrupts::~HoldInterrupts() { unfinished().mutex.unlock(); }

}  // namespace rlpc
