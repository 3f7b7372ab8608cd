// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/channel.hpp"

#include <iceoryx_posh/popo/untyped_publisher.hpp>

#include "ipc/iceoryx/chunk_order.hpp"
#include "ipc/iceoryx/raw_subscriber.hpp"

namespace isobar::ipc::detail {
namespace {

iox::capro::ServiceDescription service_of(const char* topic) {
  using iox::capro::IdString_t;
  return {IdString_t("isobar"), IdString_t("1"), IdString_t(iox::cxx::TruncateToCapacity, topic)};
}

}  // namespace

struct RawPublisher::Impl {
  iox::popo::UntypedPublisher publisher;
  std::uint32_t bytes;
  std::uint32_t alignment;

  Impl(const char* topic, const iox::popo::PublisherOptions& options, std::size_t size, std::size_t align)
      : publisher(service_of(topic), options),
        bytes(static_cast<std::uint32_t>(size)),
        alignment(static_cast<std::uint32_t>(align)) {}
};

RawPublisher::RawPublisher(const char* topic, std::uint32_t history, std::size_t bytes,
                           std::size_t alignment) {
  iox::popo::PublisherOptions options;
  options.historyCapacity = history;
  options.subscriberTooSlowPolicy = iox::popo::ConsumerTooSlowPolicy::DISCARD_OLDEST_DATA;
  impl_ = std::make_unique<Impl>(topic, options, bytes, alignment);
}

RawPublisher::~RawPublisher() = default;

void* RawPublisher::loan() noexcept {
  auto chunk = impl_->publisher.loan(impl_->bytes, impl_->alignment);
  if (chunk.has_error()) {
    return nullptr;
  }
  mark_acquired(chunk.value());
  return chunk.value();
}

void RawPublisher::publish(void* chunk) noexcept {
  mark_released(chunk);
  impl_->publisher.publish(chunk);
}

void RawPublisher::discard(void* chunk) noexcept {
  mark_released(chunk);
  impl_->publisher.release(chunk);
}

bool RawPublisher::has_subscribers() const noexcept { return impl_->publisher.hasSubscribers(); }

RawSubscriber::Impl::Impl(const char* topic, const iox::popo::SubscriberOptions& options, std::size_t size)
    : subscriber(service_of(topic), options), bytes(static_cast<std::uint32_t>(size)) {}

RawSubscriber::RawSubscriber(const char* topic, std::uint32_t depth, std::uint32_t history,
                             std::size_t bytes) {
  iox::popo::SubscriberOptions options;
  options.queueCapacity = depth;
  options.historyRequest = history;
  options.queueFullPolicy = iox::popo::QueueFullPolicy::DISCARD_OLDEST_DATA;
  impl_ = std::make_unique<Impl>(topic, options, bytes);
}

RawSubscriber::~RawSubscriber() = default;

const void* RawSubscriber::take() noexcept {
  for (;;) {
    auto chunk = impl_->subscriber.take();
    if (chunk.has_error()) {
      return nullptr;
    }
    count_gap(chunk.value());
    if (header_of(chunk.value()).userPayloadSize() == impl_->bytes) {
      mark_acquired(chunk.value());
      return chunk.value();
    }
    ++rejected_;
    impl_->subscriber.release(chunk.value());
  }
}

void RawSubscriber::count_gap(const void* chunk) noexcept {
  const iox::mepoo::ChunkHeader& header = header_of(chunk);
  const std::uint64_t sequence = header.sequenceNumber();
  if (impl_->origin == header.originId() && sequence > impl_->sequence) {
    dropped_ += sequence - impl_->sequence - 1;
  }
  impl_->origin.emplace(header.originId());
  impl_->sequence = sequence;
}

void RawSubscriber::release(const void* chunk) noexcept {
  mark_released(chunk);
  impl_->subscriber.release(chunk);
}

}  // namespace isobar::ipc::detail
