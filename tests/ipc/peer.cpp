// SPDX-License-Identifier: BSD-3-Clause
// The second process of the shared-memory tests. Exit codes: 0 success, 69 service error, 1 failure.
//   peer patient           as broker, but waits for files of other users; prints each reason once
//   peer broker            holds the broker and publishes priors with increasing heights until it is killed
//   peer read N            attaches and receives N priors; fails unless the heights increase
//   peer watch             attaches, receives one prior, then waits until the broker ends
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>

#include "core/errors.hpp"
#include "ipc/shared_memory.hpp"

namespace {

using namespace isobar;                // NOLINT(google-build-using-namespace): a test's helper
using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)

/// Prints the reason of a wait once.
bool wait_and_tell(const std::string& reason) {
  static std::string told;
  if (reason != told) std::puts(("waiting: " + reason).c_str());
  std::fflush(stdout);
  told = reason;
  std::this_thread::sleep_for(100ms);
  return true;
}

int run_broker() {
  const ipc::Broker broker;
  std::string missing_before;
  ipc::Publisher<Prior> priors(ipc::topics::kPrior);
  ipc::Subscriber<ImuSample> nothing(ipc::topics::kImu);
  ipc::Waiter waiter({&nothing.raw()});
  std::puts("ready");
  std::fflush(stdout);
  for (Prior prior;; prior.height_m += 1.0) {
    priors.send(prior);
    const std::string missing = ipc::check_broker_files();
    if (missing != missing_before) std::puts(("missing: " + missing).c_str());
    std::fflush(stdout);
    missing_before = missing;
    static_cast<void>(waiter.wait_for(5ms));
  }
}

int run_reader(int wanted, bool watch) {
  const ipc::Attachment attachment("isobar-peer", 5000ms);
  ipc::Subscriber<Prior> priors(ipc::topics::kPrior);
  ipc::Waiter waiter({&priors.raw()});
  double last = -1.0;
  for (int count = 0; count < wanted;) {
    if (waiter.wait_for(5000ms) != ipc::Waiter::Event::kData) {
      return 1;
    }
    while (const auto prior = priors.take()) {
      if (prior->height_m <= last) {
        return 1;
      }
      last = prior->height_m;
      ++count;
    }
  }
  std::puts("received");
  std::fflush(stdout);
  if (!watch) {
    return 0;
  }
  while (attachment.broker_alive()) {
    static_cast<void>(waiter.wait_for(20ms));
  }
  std::_Exit(0);  // iceoryx would detach after main() and could wait for the dead broker's answer for ever
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view role = argc > 1 ? argv[1] : "";
  try {
    if (role == "patient") ipc::set_broker_patience(wait_and_tell);
    if (role == "broker" || role == "patient") {
      return run_broker();
    }
    return run_reader(role == "read" && argc > 2 ? std::atoi(argv[2]) : 1, role == "watch");
  } catch (const Error& error) {
    std::puts(error.what());
    return error.exit_code();
  }
}
