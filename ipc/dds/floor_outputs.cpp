// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/floor_outputs.hpp"

#include <cstring>

#include "ipc/dds/messages.hpp"

namespace isobar::dds {

void FloorOutputs::open(dds_entity_t participant) {
  participant_ = participant;
  if (grid_.complete()) write_grid();
  if (number_) write_floor();
}

void FloorOutputs::close() noexcept {
  map_.reset();
  floor_.reset();
  floor_name_.reset();
  participant_ = 0;
}

void FloorOutputs::on_grid(const ipc::FloorGrid& piece, std::int64_t shift_ns) {
  if (!grid_.add(piece)) return;
  grid_shift_ns_ = shift_ns;
  write_grid();
}

void FloorOutputs::on_floor(const ipc::CurrentFloor& floor) {
  if (std::memchr(floor.name, '\0', sizeof(floor.name)) == nullptr) {
    ++floors_refused_;
    return;
  }
  if (!floor.known || (number_ == floor.number && name_ == floor.name)) return;
  number_ = floor.number;
  name_ = floor.name;
  write_floor();
}

template <class Message>
void FloorOutputs::write(std::optional<Writer<Message>>& writer, const DdsTopic<Message>& topic,
                         const std::string& name, const Message& message) {
  if (participant_ == 0) return;
  if (!writer) writer.emplace(participant_, topic, config_.ros_namespace, name);
  writer->write(message);
}

void FloorOutputs::write_grid() {
  const std::string frame = frame_of_session(config_.map_frame, grid_.session());
  write(map_, topics::kMap, config_.topics.map, grid_.message(frame, grid_shift_ns_));
}

void FloorOutputs::write_floor() {
  write(floor_, topics::kFloor, config_.topics.floor, Int32Message{*number_});
  write(floor_name_, topics::kFloorName, config_.topics.floor_name, StringMessage{text(name_)});
}

std::vector<dds_entity_t> FloorOutputs::writers() const {
  std::vector<dds_entity_t> writers;
  if (map_) writers.push_back(map_->get());
  if (floor_) writers.push_back(floor_->get());
  if (floor_name_) writers.push_back(floor_name_->get());
  return writers;
}

std::uint64_t FloorOutputs::failures() const noexcept {
  return (map_ ? map_->failures() : 0) + (floor_ ? floor_->failures() : 0) +
         (floor_name_ ? floor_name_->failures() : 0);
}

}  // namespace isobar::dds
