#include "common/io/interrupts.h"

#include <pthread.h>

#include <algorithm>
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

[[noreturn]] void end_by(int signal, const sigset_t& signals) {
  for (const int other : {SIGINT, SIGTERM, SIGHUP}) {
    if (sigismember(&signals, other) == 1) std::signal(other, SIG_DFL);
  }
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  unfinished().mutex.lock();  // never unlocked: no new file may be added
  for (const std::string& path : unfinished().paths) {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  std::raise(signal);
  std::abort();  // not reached: the default action of all three ends the process
}

}  // namespace

void handle_interrupts() {
  std::signal(SIGXFSZ, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) {
      sigaddset(&signals, signal);
    }
  }
  // A thread handles them, as signal handlers must not remove files.
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
