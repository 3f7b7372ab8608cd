// SPDX-License-Identifier: BSD-3-Clause
// Messages through shared memory, within one process and between two. Each case starts its own broker.
#include "ipc/shared_memory.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers)
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "core/errors.hpp"
#include "ipc/broker_lock.hpp"
#include "ipc/lock_bytes.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test::test_shared_memory {

using namespace isobar::ipc;

namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using test::ChildProcess;
namespace fs = std::filesystem;

TEST_CASE("a small message arrives unchanged") {
  const Broker broker;
  Publisher<Prior> publisher(topics::kPrior);
  Subscriber<Prior> subscriber(topics::kPrior);
  Prior sent;
  sent.stamp_ns = 1'234'567'890'123'456'789;
  sent.T_odom_base.translation() = Eigen::Vector3d(1.0, -2.0, 3.0);
  sent.height_m = 12.5;
  sent.height_source = HeightSource::kDifferential;
  REQUIRE(publisher.send(sent));
  const auto received = subscriber.take();
  REQUIRE(received);
  CHECK(received->stamp_ns == sent.stamp_ns);
  CHECK(received->T_odom_base.matrix() == sent.T_odom_base.matrix());
  CHECK(received->height_m == sent.height_m);
  CHECK(received->height_source == sent.height_source);
  CHECK_FALSE(subscriber.take());
}

TEST_CASE("a full queue drops its oldest messages and counts them") {
  const Broker broker;
  Publisher<PoseEstimate> publisher(topics::kPose);
  Subscriber<PoseEstimate> subscriber(topics::kPose);
  PoseEstimate pose;
  REQUIRE(publisher.send(pose));
  REQUIRE(subscriber.take());  // the first message: from here on gaps are seen
  const std::uint32_t sent = topics::kPose.depth + 7;
  for (pose.sequence = 1; pose.sequence <= sent; ++pose.sequence) {
    REQUIRE(publisher.send(pose));
  }
  CHECK(subscriber.take()->sequence == 8);
  CHECK(subscriber.dropped() == 7);
  CHECK(subscriber.take_latest()->sequence == sent);
  CHECK(subscriber.dropped() == 7);  // take_latest() discards on purpose: no loss
  CHECK(subscriber.rejected() == 0);
}

TEST_CASE("a scan is handed over without a copy, and a held message does not change") {
  const Broker broker;
  Publisher<Scan> publisher(topics::kLidarScan);
  Subscriber<Scan> subscriber(topics::kLidarScan);
  const Scan* written = nullptr;
  for (std::uint32_t sequence = 0; sequence < 3; ++sequence) {
    Scan* scan = publisher.loan();
    REQUIRE(scan != nullptr);
    scan->sequence = sequence;
    scan->point_count = Scan::kMaxPoints;
    scan->points[Scan::kMaxPoints - 1].x_m = static_cast<float>(sequence);
    written = scan;
    publisher.publish(scan);
  }
  const auto first = subscriber.take();
  const auto latest = subscriber.take_latest();
  CHECK(latest.get() == written);
  CHECK(latest->points[Scan::kMaxPoints - 1].x_m == 2.0F);
  for (int i = 0; i < 40; ++i) {  // more than the pool has: free chunks are reused, held ones are not
    Scan* scan = publisher.loan();
    REQUIRE(scan != nullptr);
    CHECK(scan->point_count == 0);  // a loan is default-constructed, without remains of an old message
    scan->point_count = 99;
    scan->sequence = 99;
    publisher.publish(scan);
  }
  CHECK(first->sequence == 0);
  CHECK(latest->sequence == 2);
}

TEST_CASE("an exhausted pool gives no loan until a chunk is returned") {
  const Broker broker;
  Publisher<Scan> publisher(topics::kLidarScan);
  std::array<Scan*, 8> loans{};
  for (Scan*& loan : loans) {
    loan = publisher.loan();
    REQUIRE(loan != nullptr);
  }
  CHECK(publisher.loan() == nullptr);
  publisher.discard(loans[0]);
  loans[0] = publisher.loan();
  CHECK(loans[0] != nullptr);
  for (Scan* loan : loans) {
    publisher.discard(loan);
  }
}

TEST_CASE("a late subscriber gets the last map") {
  const Broker broker;
  Publisher<MapCloud> publisher(topics::kMapCloud);
  for (std::uint32_t sequence = 1; sequence <= 2; ++sequence) {
    MapCloud* map = publisher.loan();
    REQUIRE(map != nullptr);
    map->sequence = sequence;
    publisher.publish(map);
  }
  Subscriber<MapCloud> subscriber(topics::kMapCloud);
  Waiter waiter({&subscriber.raw()});
  REQUIRE(waiter.wait_for(2s) == Waiter::Event::kData);
  CHECK(subscriber.take()->sequence == 2);
}

TEST_CASE("a waiter wakes for any of its subscribers, times out without data, and stops on request") {
  const Broker broker;
  Publisher<WheelSample> wheels(topics::kWheel);
  Subscriber<ImuSample> imu(topics::kImu);
  Subscriber<WheelSample> wheel(topics::kWheel);
  Waiter waiter({&imu.raw(), &wheel.raw()});
  CHECK(waiter.wait_for(1ms) == Waiter::Event::kTimeout);
  REQUIRE(wheels.send({}));
  CHECK(waiter.wait() == Waiter::Event::kData);
  CHECK(waiter.wait() == Waiter::Event::kData);  // level-triggered: while the message is waiting
  static_cast<void>(wheel.take());
  CHECK(waiter.wait_for(1ms) == Waiter::Event::kTimeout);

  Waiter::Event last = Waiter::Event::kData;
  std::thread sleeper([&] { last = waiter.wait(); });
  waiter.stop();
  sleeper.join();
  CHECK(last == Waiter::Event::kStopped);
  CHECK(waiter.wait() == Waiter::Event::kStopped);
}

TEST_CASE("a health report truncates long texts, and its last entry counts those beyond its capacity") {
  HealthReport report;
  const std::string longer(200, 'x');
  REQUIRE(report.add(longer, HealthLevel::kWarning, longer, 1.5));
  CHECK(std::string_view(report.entries[0].name) == std::string(HealthEntry::kNameBytes - 1, 'x'));
  CHECK(std::string_view(report.entries[0].message) == std::string(HealthEntry::kMessageBytes - 1, 'x'));
  while (report.entry_count < HealthReport::kMaxEntries - 1) {
    REQUIRE(report.add("name", HealthLevel::kOk, "", 0.0));
  }
  for (double dropped = 1.0; dropped <= 3.0; dropped += 1.0) {
    CHECK_FALSE(report.add("name", HealthLevel::kOk, "", 0.0));
    REQUIRE(report.entry_count == HealthReport::kMaxEntries);
    const HealthEntry& last = report.entries[HealthReport::kMaxEntries - 1];
    CHECK(std::string_view(last.name) == HealthReport::kDroppedName);
    CHECK(last.level == HealthLevel::kWarning);
    CHECK(last.value == dropped);
  }
}

TEST_CASE("another process receives the messages of this one") {
  const Broker broker;
  Publisher<Prior> priors(topics::kPrior);
  Subscriber<ImuSample> nothing(topics::kImu);
  Waiter pause({&nothing.raw()});
  ChildProcess reader({ISOBAR_IPC_PEER, "read", "50"});
  Prior prior;
  for (int i = 0; i < 2000 && reader.running(); ++i, prior.height_m += 1.0) {
    REQUIRE(priors.send(prior));
    static_cast<void>(pause.wait_for(5ms));
  }
  CHECK(reader.wait(5s) == 0);
}

TEST_CASE("a killed subscriber neither blocks the publisher nor counts as a fault of the library") {
  const Broker broker;
  const std::uint64_t faults = library_fault_count();
  Publisher<Prior> priors(topics::kPrior);
  Subscriber<ImuSample> nothing(topics::kImu);
  Waiter pause({&nothing.raw()});
  ChildProcess reader({ISOBAR_IPC_PEER, "watch"});
  Prior prior;
  for (int i = 0; i < 2000 && !priors.has_subscribers(); ++i, prior.height_m += 1.0) {
    static_cast<void>(pause.wait_for(5ms));
  }
  REQUIRE(priors.has_subscribers());
  const std::string socket = "/tmp/isobar-peer-" + std::to_string(reader.pid());
  CHECK(fs::exists(socket));
  reader.signal(SIGKILL);
  CHECK(reader.wait(5s) == 128 + SIGKILL);
  for (int i = 0; i < 10'000; ++i) {  // many times the queue's depth and the pool's size
    REQUIRE(priors.send(prior));
  }
  for (int i = 0; i < 100 && (fs::exists(socket) || fs::exists(socket + ".lock")); ++i) {
    static_cast<void>(pause.wait_for(20ms));
  }
  CHECK_FALSE(fs::exists(socket));
  CHECK_FALSE(fs::exists(socket + ".lock"));
  CHECK(library_fault_count() == faults);
}

TEST_CASE("attached processes notice a killed broker, and the next broker starts despite its leftovers") {
  ChildProcess first({ISOBAR_IPC_PEER, "broker"});
  REQUIRE(first.read_until("ready", 10s));
  ChildProcess reader({ISOBAR_IPC_PEER, "watch"});
  REQUIRE(reader.read_until("received", 10s));
  CHECK(reader.running());
  first.signal(SIGKILL);
  CHECK(first.wait(5s) == 128 + SIGKILL);
  CHECK(reader.wait(5s) == 0);
  ChildProcess second({ISOBAR_IPC_PEER, "broker"});
  REQUIRE(second.read_until("ready", 10s));
  ChildProcess next_reader({ISOBAR_IPC_PEER, "read", "3"});
  CHECK(next_reader.wait(10s) == 0);
}

/// Sends priors until the attached peer says that it has received one. Each is higher than the one before, which the
/// peer demands of all that wait in its queue.
void send_until_received(Publisher<Prior>& priors, ChildProcess& reader) {
  std::string line;
  Prior prior;
  while (!reader.read_line(line, 5ms)) {
    REQUIRE(reader.running());
    prior.height_m += 1.0;
    REQUIRE(priors.send(prior));
  }
  CHECK(line == "received");
}

TEST_CASE("a broker that ends waits until the attached processes have detached") {
  auto broker = std::make_unique<Broker>();
  auto priors = std::make_unique<Publisher<Prior>>(topics::kPrior);
  ChildProcess reader({ISOBAR_IPC_PEER, "watch"});
  send_until_received(*priors, reader);
  const std::uint64_t faults = library_fault_count();
  priors.reset();
  broker.reset();
  // A broker that did not wait would have made the library end the reader with another code.
  CHECK(reader.wait(5s) == 0);
  CHECK(library_fault_count() == faults);
}

TEST_CASE("a broker ends soon although an attached process hangs") {
  auto broker = std::make_unique<Broker>();
  auto priors = std::make_unique<Publisher<Prior>>(topics::kPrior);
  ChildProcess reader({ISOBAR_IPC_PEER, "watch"});
  send_until_received(*priors, reader);
  reader.signal(SIGSTOP);
  const auto began = std::chrono::steady_clock::now();
  priors.reset();
  broker.reset();
  CHECK(std::chrono::steady_clock::now() - began < 1900ms);
  reader.signal(SIGCONT);
  CHECK(reader.wait(5s) == 0);
  const Broker next;  // nothing is left in its way
}

TEST_CASE("the number of a killed broker is not taken for that of the next one, which is just starting") {
  ChildProcess killed({ISOBAR_IPC_PEER, "broker"});
  REQUIRE(killed.read_until("ready", 10s));
  killed.signal(SIGKILL);
  REQUIRE(killed.wait(5s) == 128 + SIGKILL);
  const int file = ::open("/dev/shm/isobar.lock", O_RDWR | O_CLOEXEC);
  std::uint64_t instance = 0;
  REQUIRE(read_instance(file, instance));
  REQUIRE(lock_byte(file, LockByte::kOwner));  // as the next one, before it has cleared the number
  CHECK_THROWS_AS(static_cast<void>(BrokerWatch::find(50ms)), ServiceError);
  REQUIRE(announce_instance(file, ++instance));
  const BrokerWatch watch = BrokerWatch::find(50ms);
  CHECK(watch.alive());
  ::close(file);
  CHECK_FALSE(watch.alive());
}

TEST_CASE("a second broker is refused with the reason") {
  ChildProcess first({ISOBAR_IPC_PEER, "broker"});
  REQUIRE(first.read_until("ready", 10s));
  ChildProcess reader({ISOBAR_IPC_PEER, "watch"});
  REQUIRE(reader.read_until("received", 10s));
  ChildProcess second({ISOBAR_IPC_PEER, "broker"});
  CHECK(second.read_until("another isobard is running", 10s));
  CHECK(second.wait(5s) == 69);
  CHECK(first.running());
  CHECK(reader.running());  // attached processes are not disturbed
  ChildProcess late({ISOBAR_IPC_PEER, "read", "3"});
  CHECK(late.wait(10s) == 0);
  CHECK_THROWS_WITH_AS(Broker(), doctest::Contains("another isobard is running"), ServiceError);
}

TEST_CASE("attaching without a broker is refused after the timeout") {
  CHECK_THROWS_WITH_AS(Attachment("test", 50ms), doctest::Contains("isobard is not running"), ServiceError);
}

}  // namespace

}  // namespace isobar::test::test_shared_memory
