// SPDX-License-Identifier: BSD-3-Clause
#include <sys/stat.h>
#include <unistd.h>

#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <string>

#include "core/errors.hpp"
#include "ipc/broker.hpp"
#include "ipc/broker_lock.hpp"
#include "ipc/iceoryx/library_errors.hpp"
#include "ipc/leftovers.hpp"

namespace isobar::ipc {

namespace {

/// Checks what the library would answer with silence, lines for each failed call, or a segmentation fault.
void require_rights() {
  struct stat segment {};
  if (::stat(Rendezvous::kManagement, &segment) != 0) {
    throw ServiceError(std::string("isobard runs, but its shared memory ") + Rendezvous::kManagement +
                       " was removed; programs can attach again after a restart of isobard");
  }
  if (!is_member_of_owner(Rendezvous::kManagement)) throw ServiceError(not_a_member(Rendezvous::kManagement));
}

}  // namespace

struct Attachment::Impl {
  BrokerWatch watch;
};

Attachment::Attachment(const char* name, std::chrono::milliseconds timeout) {
  prepare_library();
  impl_ = std::make_unique<Impl>(Impl{BrokerWatch::find(timeout)});
  require_rights();
  const std::string full_name = std::string(name) + "-" + std::to_string(::getpid());
  iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, full_name.c_str()));
}

Attachment::~Attachment() = default;

bool Attachment::broker_alive() const noexcept { return impl_->watch.alive(); }

}  // namespace isobar::ipc
