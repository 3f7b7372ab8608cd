// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/qos.hpp"

namespace isobar::dds {
namespace {

/// Longest time that a writer blocks for a slow reader before it drops the message [ns]: a stopped viewer
/// must not stop odometry.
constexpr dds_duration_t kMaxBlockingNs = DDS_MSECS(10);

}  // namespace

QosPointer make_qos() { return QosPointer(dds_create_qos()); }

QosPointer endpoint_qos(Delivery delivery, int depth) {
  QosPointer qos = make_qos();
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_reliability(
      qos.get(), delivery == Delivery::kBestEffort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
      kMaxBlockingNs);
  dds_qset_durability(
      qos.get(), delivery == Delivery::kLatched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  // ROS 2 uses XCDR1 only. Readers of other vendors match an XCDR2 writer but receive nothing from it.
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &representation);
  return qos;
}

}  // namespace isobar::dds
