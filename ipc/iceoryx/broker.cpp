// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/broker.hpp"

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <iceoryx_hoofs/posix_wrapper/posix_access_rights.hpp>
#include <iceoryx_posh/roudi/iceoryx_roudi_components.hpp>
#include <iceoryx_posh/runtime/posh_runtime_single_process.hpp>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "ipc/broker_lock.hpp"
#include "ipc/iceoryx/library_errors.hpp"
#include "ipc/iceoryx/roudi.hpp"
#include "ipc/leftovers.hpp"
#include "ipc/topics.hpp"

namespace isobar::ipc {
namespace {

constexpr std::uint64_t kMegabyteBytes = 1ULL << 20;
/// iceoryx's management segment: 66 MB measured with Debian's 2.0.3, plus 1 MB for page rounding.
constexpr std::uint64_t kManagementBytes = 67 * kMegabyteBytes;
/// Upper bound of iceoryx's header in front of each payload and of the rounding of chunk sizes.
constexpr std::uint64_t kChunkHeaderBytes = 64;
/// Longest wait for attached processes to detach. isobar-dds does in 0.1 s. Bounds the stop of isobard, which
/// takes less than 1 s whatever the others do: hang, or attach at this moment.
constexpr auto kDetachTimeout = std::chrono::milliseconds(500);

/// Discards what the library prints while the broker starts, regardless of its log level.
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

auto group_of_process() { return iox::posix::PosixGroup::getGroupOfCurrentProcess().getName(); }

/// Space of the segments that a killed isobard left in /dev/shm [bytes]. The library removes them at the next
/// start, hence it counts as free.
std::uint64_t leftover_bytes() {
  constexpr std::uint64_t kBlockBytes = 512;  // unit of st_blocks, stat(2)
  std::uint64_t bytes = 0;
  for (const std::string& name : {std::string("iceoryx_mgmt"), std::string(group_of_process())}) {
    struct stat status {};
    if (::stat(("/dev/shm/" + name).c_str(), &status) == 0) {
      bytes += static_cast<std::uint64_t>(status.st_blocks) * kBlockBytes;
    }
  }
  return bytes;
}

void require_space() {
  struct statvfs status {};
  if (::statvfs("/dev/shm", &status) != 0) {
    throw ServiceError("/dev/shm: not mounted; shared memory needs it");
  }
  const std::uint64_t available_bytes = status.f_bavail * status.f_frsize + leftover_bytes();
  if (available_bytes < Broker::needed_bytes()) {
    const std::uint64_t needed_mb = (Broker::needed_bytes() + kMegabyteBytes - 1) / kMegabyteBytes;
    throw ServiceError("/dev/shm: " + std::to_string(needed_mb) + " MB needed, " +
                       std::to_string(available_bytes / kMegabyteBytes) +
                       " MB available; enlarge it (mount -o remount,size=256M /dev/shm)");
  }
}

iox::RouDiConfig_t memory_config() {
  iox::mepoo::MePooConfig pools;
  for (const ChunkPool& pool : kChunkPools) {
    pools.addMemPool({pool.chunk_bytes, pool.chunk_count});
  }
  const auto group = group_of_process();
  iox::RouDiConfig_t config;
  config.m_sharedMemorySegments.push_back({group, group, pools});
  return config;
}

}  // namespace

namespace {

// Of the one Broker of this process; main thread.
BrokerPatience g_patience;            // NOLINT(cert-err58-cpp)
BrokerLock* g_broker_lock = nullptr;  // null: no Broker
std::vector<std::string> g_files;     // that other processes need to attach

BrokerLock acquire_patiently() {
  for (;;) {
    try {
      return BrokerLock::acquire();
    } catch (const ObstructedError& error) {
      if (!g_patience || !g_patience(error.what())) throw;
    }
  }
}

}  // namespace

struct Broker::Impl {
  BrokerLock lock;
  iox::roudi::IceOryxRouDiComponents components;
  PidfdRouDi roudi;
  iox::runtime::PoshRuntimeSingleProcess runtime;

  explicit Impl(BrokerLock&& held)
      : lock(std::move(held)),
        components(memory_config()),
        roudi(components.rouDiMemoryManager, components.portManager),
        runtime("isobard") {}
};

Broker::Broker() {
  prepare_library();
  BrokerLock lock = acquire_patiently();
  require_space();
  const MutedStreams muted;
  impl_ = std::make_unique<Impl>(std::move(lock));
  impl_->lock.announce();
  g_broker_lock = &impl_->lock;
  for (const char* path : {Rendezvous::kManagement, "/tmp/roudi", Rendezvous::kLibraryLock}) {
    g_files.push_back(path);
  }
  g_files.push_back("/dev/shm/" + std::string(group_of_process()));
}

Broker::~Broker() {
  g_broker_lock = nullptr;
  g_files.clear();
  impl_->lock.withdraw(kDetachTimeout);
}

void set_broker_patience(BrokerPatience patience) { g_patience = std::move(patience); }

std::string check_broker_files() {
  if (g_broker_lock == nullptr) return {};
  g_broker_lock->put_back();
  std::string missing;
  for (const std::string& path : g_files) {
    if (::access(path.c_str(), F_OK) != 0) missing += (missing.empty() ? "" : ", ") + path;
  }
  return missing;
}

std::uint64_t Broker::needed_bytes() noexcept {
  std::uint64_t bytes = kManagementBytes;
  for (const ChunkPool& pool : kChunkPools) {
    bytes += pool.chunk_count * (pool.chunk_bytes + kChunkHeaderBytes);
  }
  return bytes;
}

}  // namespace isobar::ipc
