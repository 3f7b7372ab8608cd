// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iceoryx_posh/popo/untyped_subscriber.hpp>
#include <optional>

#include "ipc/channel.hpp"

namespace isobar::ipc::detail {

/// The library's side of a RawSubscriber, shared by channel.cpp and waiter.cpp.
struct RawSubscriber::Impl {
  iox::popo::UntypedSubscriber subscriber;
  std::uint32_t bytes;                            ///< expected size of the payload
  std::optional<iox::popo::UniquePortId> origin;  ///< publisher of the last chunk
  std::uint64_t sequence = 0;                     ///< its sequence number

  Impl(const char* topic, const iox::popo::SubscriberOptions& options, std::size_t size);
};

}  // namespace isobar::ipc::detail
