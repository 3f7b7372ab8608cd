// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <string>

#include "ipc/broker.hpp"
#include "ipc/broker_lock.hpp"
#include "ipc/iceoryx/library_errors.hpp"

namespace isobar::ipc {

struct Attachment::Impl {
  BrokerWatch watch;
};

Attachment::Attachment(const char* name, std::chrono::milliseconds timeout) {
  prepare_library();
  impl_ = std::make_unique<Impl>(Impl{BrokerWatch::find(timeout)});
  const std::string full_name = std::string(name) + "-" + std::to_string(::getpid());
  iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, full_name.c_str()));
}

Attachment::~Attachment() = default;

bool Attachment::broker_alive() const noexcept { return impl_->watch.alive(); }

}  // namespace isobar::ipc
