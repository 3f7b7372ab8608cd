// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/shared_memory.hpp"

#include <poll.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <iceoryx_hoofs/error_handling/error_handling.hpp>
#include <iceoryx_hoofs/log/logmanager.hpp>
#include <iceoryx_hoofs/posix_wrapper/posix_access_rights.hpp>
#include <iceoryx_posh/internal/roudi/roudi.hpp>
#include <iceoryx_posh/popo/untyped_publisher.hpp>
#include <iceoryx_posh/popo/untyped_subscriber.hpp>
#include <iceoryx_posh/popo/user_trigger.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>
#include <iceoryx_posh/roudi/iceoryx_roudi_components.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <iceoryx_posh/runtime/posh_runtime_single_process.hpp>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "ipc/broker_lock.hpp"

// ThreadSanitizer sees only this program's code, not the atomics inside the library that order the hand-over
// of a chunk, so the order is told here.
#if defined(__SANITIZE_THREAD__)
#define ISOBAR_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define ISOBAR_TSAN 1
#endif
#endif
// Told of the header at the start of the chunk: what follows it begins where the type of the topic that has
// the chunk now wants it, and that may be another place than where it began in the topic before.
#ifdef ISOBAR_TSAN
extern "C" void __tsan_acquire(void* address);  // NOLINT(bugprone-reserved-identifier)
extern "C" void __tsan_release(void* address);  // NOLINT(bugprone-reserved-identifier)
#endif

namespace isobar::ipc {
namespace {

/// The library keeps the numbers of a chunk in front of it.
const iox::mepoo::ChunkHeader& header_of(const void* chunk) {
  return *iox::mepoo::ChunkHeader::fromUserPayload(chunk);
}

void mark_acquired([[maybe_unused]] const void* chunk) noexcept {
#ifdef ISOBAR_TSAN
  __tsan_acquire(const_cast<iox::mepoo::ChunkHeader*>(&header_of(chunk)));
#endif
}

void mark_released([[maybe_unused]] const void* chunk) noexcept {
#ifdef ISOBAR_TSAN
  __tsan_release(const_cast<iox::mepoo::ChunkHeader*>(&header_of(chunk)));
#endif
}

/// iceoryx's own bookkeeping, measured on 2.0.3 as Debian builds it; a megabyte is added for page rounding.
constexpr std::uint64_t kManagementBytes = 67ULL << 20;
/// iceoryx puts a header before every payload and rounds chunks up.
constexpr std::uint64_t kChunkHeaderBytes = 64;
constexpr std::uint64_t kMegabyte = 1ULL << 20;

/// Attached processes look for their broker a few times a second, see Attachment::broker_alive().
constexpr auto kPatience = std::chrono::seconds(2);

std::atomic<std::uint64_t> g_library_faults{0};
std::atomic<FatalAction> g_fatal_action{nullptr};

void handle_library_error(const iox::Error error, const std::function<void()>& /*callback*/,
                          const iox::ErrorLevel level) {
  g_library_faults.fetch_add(1, std::memory_order_relaxed);
  if (level != iox::ErrorLevel::FATAL) {
    return;
  }
  // The library cannot go on after this and must not be returned to; its destructors would fail as well.
  std::fprintf(stderr, "shared memory: fatal fault %s in the iceoryx library\n",
               iox::ErrorHandler::toString(error));
  if (const FatalAction action = g_fatal_action.load()) {
    action();
  }
  std::_Exit(69);
}

/// Debian's iceoryx ends the process at severe errors too, unless a handler of ours is installed. It stays
/// for the whole life of the process, so it is never given back.
void prepare_library() {
  static const bool kPrepared = [] {
    iox::log::LogManager::GetLogManager().SetDefaultLogLevel(iox::log::LogLevel::kOff,
                                                             iox::log::LogLevelOutput::kHideLogLevel);
    static auto* kept = new iox::cxx::GenericRAII(
        iox::ErrorHandler::setTemporaryErrorHandler(iox::HandlerFunction(handle_library_error)));
    return kept != nullptr;
  }();
  static_cast<void>(kPrepared);
}

/// Silences what the library prints past its own log level while the broker starts.
class MutedStreams {
 public:
  MutedStreams() : out_(std::cout.rdbuf(nullptr)), log_(std::clog.rdbuf(nullptr)) {}
  ~MutedStreams() {
    std::cout.rdbuf(out_);
    std::clog.rdbuf(log_);
  }
  MutedStreams(const MutedStreams&) = delete;
  MutedStreams& operator=(const MutedStreams&) = delete;

 private:
  std::streambuf* out_;
  std::streambuf* log_;
};

std::string own_group() { return std::string(iox::posix::PosixGroup::getGroupOfCurrentProcess().getName()); }

/// Who is attached.
class AttachedProcesses {
 public:
  AttachedProcesses() = default;
  ~AttachedProcesses() {
    for (const auto& [name, descriptor] : processes_) ::close(descriptor);
  }
  AttachedProcesses(const AttachedProcesses&) = delete;
  AttachedProcesses& operator=(const AttachedProcesses&) = delete;

  void add(const iox::RuntimeName_t& name, pid_t pid) {
    const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
    const std::lock_guard lock(mutex_);
    if (descriptor >= 0) processes_.emplace_back(name, descriptor);
  }
  /// Forgets those that have ended, and calls `gone(name)` for each.
  template <class Gone>
  void remove_ended(const Gone& gone) {
    const std::lock_guard lock(mutex_);
    std::erase_if(processes_, [&gone](const auto& process) {
      pollfd ended{process.second, POLLIN, 0};
      if (::poll(&ended, 1, 0) <= 0) return false;
      gone(process.first);
      ::close(process.second);
      return true;
    });
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<iox::RuntimeName_t, int>> processes_;  // pidfd_open(2)
};

/// The library's own watch over those who are attached goes by the clock: an isobard that was stopped for 1.5
/// s (a debugger, a frozen machine) gives up all of them as soon as it goes on, and itself too, which ends
/// it. Here a process is given up when the kernel says that it has ended, and never else: who hangs does no
/// harm, as full queues drop their oldest message.
class PatientRouDi
    : private AttachedProcesses,  // first: the library's threads start in the constructor of the second
      public iox::roudi::RouDi {
 public:
  PatientRouDi(iox::roudi::RouDiMemoryInterface& memory, iox::roudi::PortManager& ports)
      : RouDi(memory, ports,
              RoudiStartupParameters(iox::roudi::MonitoringMode::OFF, /*killProcessesInDestructor=*/false,
                                     RuntimeMessagesThreadStart::DEFER_START)) {
    startProcessRuntimeMessagesThread();
  }
  ~PatientRouDi() override { shutdown(); }
  PatientRouDi(const PatientRouDi&) = delete;
  PatientRouDi& operator=(const PatientRouDi&) = delete;

 private:
  void processMessage(const iox::runtime::IpcMessage& message, const iox::runtime::IpcMessageType& command,
                      const iox::RuntimeName_t& name) noexcept override {
    constexpr std::uint32_t kElementsOfRegister = 6;
    RouDi::processMessage(message, command, name);
    if (command != iox::runtime::IpcMessageType::REG ||
        message.getNumberOfElements() != kElementsOfRegister) {
      return;
    }
    std::uint32_t pid = 0;
    uid_t user = 0;
    std::int64_t sent = 0;
    static_cast<void>(parseRegisterMessage(message, pid, user, sent));
    if (static_cast<pid_t>(pid) != ::getpid()) add(name, static_cast<pid_t>(pid));
  }

  // Every 100 ms.
  void cyclicUpdateHook() noexcept override {
    remove_ended(
        [this](const iox::RuntimeName_t& name) { static_cast<void>(m_prcMgr->unregisterProcess(name)); });
  }
};

/// What a killed isobard left behind is removed at the next start, so its space counts as free.
std::uint64_t bytes_of_leftovers() {
  std::uint64_t bytes = 0;
  for (const std::string& name : {std::string("iceoryx_mgmt"), own_group()}) {
    struct stat status {};
    if (::stat(("/dev/shm/" + name).c_str(), &status) == 0) {
      bytes += static_cast<std::uint64_t>(status.st_blocks) * 512U;
    }
  }
  return bytes;
}

void require_space() {
  struct statvfs status {};
  if (::statvfs("/dev/shm", &status) != 0) {
    throw ServiceError("/dev/shm: not mounted; shared memory needs it");
  }
  const std::uint64_t available = status.f_bavail * status.f_frsize + bytes_of_leftovers();
  if (available < Broker::needed_bytes()) {
    throw ServiceError("/dev/shm: " + std::to_string((Broker::needed_bytes() + kMegabyte - 1) / kMegabyte) +
                       " MB needed, " + std::to_string(available / kMegabyte) +
                       " MB available; enlarge it (mount -o remount,size=256M /dev/shm)");
  }
}

iox::RouDiConfig_t memory_config() {
  iox::mepoo::MePooConfig pools;
  for (const ChunkPool& pool : kChunkPools) {
    pools.addMemPool({pool.chunk_bytes, pool.chunk_count});
  }
  const auto group = iox::posix::PosixGroup::getGroupOfCurrentProcess().getName();
  iox::RouDiConfig_t config;
  config.m_sharedMemorySegments.push_back({group, group, pools});
  return config;
}

iox::capro::ServiceDescription service_of(const char* topic) {
  using iox::capro::IdString_t;
  return {IdString_t("isobar"), IdString_t("1"), IdString_t(iox::cxx::TruncateToCapacity, topic)};
}

}  // namespace

std::uint64_t library_fault_count() noexcept { return g_library_faults.load(std::memory_order_relaxed); }

void set_fatal_action(FatalAction action) noexcept { g_fatal_action.store(action); }

// ---------------------------------------------------------------------------------------------- Broker

struct Broker::Impl {
  BrokerLock lock;
  iox::roudi::IceOryxRouDiComponents components;
  PatientRouDi roudi;
  iox::runtime::PoshRuntimeSingleProcess runtime;

  explicit Impl(BrokerLock&& held)
      : lock(std::move(held)),
        components(memory_config()),
        roudi(components.rouDiMemoryManager, components.portManager),
        runtime("isobard") {}
};

Broker::Broker() {
  prepare_library();
  BrokerLock lock = BrokerLock::acquire();
  require_space();
  const MutedStreams muted;
  impl_ = std::make_unique<Impl>(std::move(lock));
  impl_->lock.announce();
}

Broker::~Broker() { impl_->lock.withdraw(kPatience); }

std::uint64_t Broker::needed_bytes() noexcept {
  std::uint64_t bytes = kManagementBytes;
  for (const ChunkPool& pool : kChunkPools) {
    bytes += pool.chunk_count * (pool.chunk_bytes + kChunkHeaderBytes);
  }
  return bytes;
}

// ------------------------------------------------------------------------------------------ Attachment

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

// ----------------------------------------------------------------------------- Publisher and Subscriber

namespace detail {

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
    ++loan_failures_;
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

struct RawSubscriber::Impl {
  iox::popo::UntypedSubscriber subscriber;
  std::uint32_t bytes;
  std::optional<iox::popo::UniquePortId> origin;
  std::uint64_t sequence = 0;

  Impl(const char* topic, const iox::popo::SubscriberOptions& options, std::size_t size)
      : subscriber(service_of(topic), options), bytes(static_cast<std::uint32_t>(size)) {}
};

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

bool RawSubscriber::has_data() const noexcept { return impl_->subscriber.hasData(); }

}  // namespace detail

// ---------------------------------------------------------------------------------------------- Waiter

struct Waiter::Impl {
  iox::popo::UserTrigger trigger;
  iox::popo::WaitSet<Waiter::kMaxSubscribers + 1> set;
  std::atomic<bool> stopped{false};

  template <class Wait>
  Event wait(Wait&& wait_on_set) noexcept {
    if (stopped.load(std::memory_order_acquire)) {
      return Event::kStopped;
    }
    const auto notifications = wait_on_set();
    if (stopped.load(std::memory_order_acquire)) {
      return Event::kStopped;
    }
    return notifications.empty() ? Event::kTimeout : Event::kData;
  }
};

Waiter::Waiter(std::initializer_list<detail::RawSubscriber*> subscribers) : impl_(std::make_unique<Impl>()) {
  bool attached = subscribers.size() <= kMaxSubscribers;
  attached = attached && !impl_->set.attachEvent(impl_->trigger).has_error();
  for (detail::RawSubscriber* subscriber : subscribers) {
    attached = attached &&
               !impl_->set.attachState(subscriber->impl_->subscriber, iox::popo::SubscriberState::HAS_DATA)
                    .has_error();
  }
  if (!attached) {
    throw ServiceError("shared memory: a waiter could not be attached to its " +
                       std::to_string(subscribers.size()) + " subscribers");
  }
}

Waiter::~Waiter() = default;

Waiter::Event Waiter::wait() noexcept {
  return impl_->wait([this] { return impl_->set.wait(); });
}

Waiter::Event Waiter::wait_for(std::chrono::nanoseconds timeout) noexcept {
  const auto limit = iox::units::Duration::fromNanoseconds(timeout.count());
  return impl_->wait([this, limit] { return impl_->set.timedWait(limit); });
}

void Waiter::stop() noexcept {
  impl_->stopped.store(true, std::memory_order_release);
  impl_->trigger.trigger();
}

void Waiter::wake() noexcept { impl_->trigger.trigger(); }

}  // namespace isobar::ipc
