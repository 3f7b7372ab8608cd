// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/bus/smbus.hpp"

#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace isobar {

namespace {

/// One SMBus transaction. 0 or errno.
int transfer(int file, char direction, std::uint8_t command, std::uint32_t size, i2c_smbus_data* data) {
  i2c_smbus_ioctl_data arguments{};
  arguments.read_write = static_cast<std::uint8_t>(direction);
  arguments.command = command;
  arguments.size = size;
  arguments.data = data;
  return ioctl(file, I2C_SMBUS, &arguments) < 0 ? errno : 0;
}

}  // namespace

SmbusDevice::SmbusDevice(std::string bus, std::uint8_t address) : bus_(std::move(bus)), address_(address) {}

SmbusDevice::~SmbusDevice() { close(); }

void SmbusDevice::close() noexcept {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

int SmbusDevice::open() noexcept {
  close();
  file_ = ::open(bus_.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) return errno;
  unsigned long functions = 0;
  if (ioctl(file_, I2C_FUNCS, &functions) < 0) {
    const int error = errno;
    close();
    return error;
  }
  if ((functions & I2C_FUNC_SMBUS_BYTE_DATA) != I2C_FUNC_SMBUS_BYTE_DATA) {
    close();
    return ENOTSUP;
  }
  has_commands_ = (functions & I2C_FUNC_SMBUS_WRITE_BYTE) != 0;
  has_block_reads_ = (functions & I2C_FUNC_SMBUS_READ_I2C_BLOCK) != 0;
  if (ioctl(file_, I2C_SLAVE, static_cast<unsigned long>(address_)) < 0) {
    const int error = errno;
    close();
    return error;
  }
  return 0;
}

int SmbusDevice::read(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept {
  if (bytes.size() > I2C_SMBUS_BLOCK_MAX) return EINVAL;
  if (has_block_reads_ && bytes.size() > 1) return read_block(first, bytes);
  for (std::uint8_t& byte : bytes) {
    if (const int error = read_byte(first++, byte); error != 0) return error;
  }
  return 0;
}

int SmbusDevice::read_byte(std::uint8_t address, std::uint8_t& value) noexcept {
  i2c_smbus_data data{};
  const int error = transfer(file_, I2C_SMBUS_READ, address, I2C_SMBUS_BYTE_DATA, &data);
  if (error == 0) value = data.byte;
  return error;
}

int SmbusDevice::read_block(std::uint8_t first, std::span<std::uint8_t> bytes) noexcept {
  i2c_smbus_data data{};
  data.block[0] = static_cast<std::uint8_t>(bytes.size());  // in: bytes wanted; out: bytes read
  if (const int error = transfer(file_, I2C_SMBUS_READ, first, I2C_SMBUS_I2C_BLOCK_DATA, &data); error != 0) {
    return error;
  }
  if (data.block[0] != bytes.size()) return EIO;
  std::copy_n(&data.block[1], bytes.size(), bytes.begin());
  return 0;
}

int SmbusDevice::write(std::uint8_t address, std::uint8_t value) noexcept {
  i2c_smbus_data data{};
  data.byte = value;
  return transfer(file_, I2C_SMBUS_WRITE, address, I2C_SMBUS_BYTE_DATA, &data);
}

int SmbusDevice::command(std::uint8_t code) noexcept {
  if (!has_commands_) return file_ < 0 ? EBADF : ENOTSUP;
  return transfer(file_, I2C_SMBUS_WRITE, code, I2C_SMBUS_BYTE, nullptr);
}

}  // namespace isobar
