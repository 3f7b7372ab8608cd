// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a capture file.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/errors.hpp"
#include "run/recording/pcap_packets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int memory = memfd_create("capture", MFD_CLOEXEC);
  if (ftruncate(memory, 0) != 0 || pwrite(memory, data, size, 0) != static_cast<ssize_t>(size)) {
    return 0;
  }
  try {
    isobar::recording::PcapPackets packets("/proc/self/fd/" + std::to_string(memory), {2'368, 8'308}, {});
    isobar::recording::StampedPacket packet;
    while (packets.next(packet)) {
      if (packet.payload.size() > 65'535) {
        std::abort();
      }
    }
  } catch (const isobar::DataError&) {
    return 0;  // not a capture file
  }
  return 0;
}
