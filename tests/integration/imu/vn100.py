#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A VN-100 on a pseudo-terminal behind a symbolic link: answers the register commands that it is sent and, once
register 75 is set, sends packets at the rate of its divisor. While the file STOP exists, the sensor is unplugged.

Usage: vn100.py LINK STOP
"""
import os
import select
import struct
import sys
import time
import tty

LINK, STOP = sys.argv[1:3]


def crc(data):
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = ((value << 1) ^ 0x1021) & 0xFFFF if value & 0x8000 else value << 1
    return value


def line(body):
    total = 0
    for char in body.encode():
        total ^= char
    return b"$%s*%02X\r\n" % (body.encode(), total)


def packet(now, count):
    body = struct.pack("<BHH", 5, 0x0201, 0x0030) + struct.pack("<Q", int(now * 1e9))
    body += struct.pack("<8f", 0.1, -0.2, -9.8, 0.01, -0.02, 1e-4 * (count % 100), 21.5, 101.0 + 0.001 * (count % 50))
    return b"\xfa" + body + struct.pack(">H", crc(body))


def serve():
    """One plugging-in, until the file STOP exists."""
    master, slave = os.openpty()
    tty.setraw(slave)
    os.set_blocking(master, False)
    os.symlink(os.ttyname(slave), LINK)
    os.close(slave)
    registers, heard, start, due, count = {}, b"", time.monotonic(), time.monotonic(), 0
    while not os.path.exists(STOP):
        select.select([], [], [], 0.001)
        try:
            heard += os.read(master, 1024)
        except OSError:
            pass  # nothing waits, or nobody has the port open
        while b"\r\n" in heard:
            command, heard = heard.split(b"\r\n", 1)
            fields = command.decode().lstrip("$").split("*")[0].split(",")
            if fields[0] == "VNWRG":
                registers[fields[1]] = fields[2:]
            os.write(master, line(",".join(fields[:2] + registers.get(fields[1], []))))
        period = int(registers["75"][1]) / 800.0 if "75" in registers else 0.0
        while period and time.monotonic() >= due:
            try:
                os.write(master, packet(due - start, count))
            except OSError:
                pass
            due, count = due + period, count + 1
        if not period:
            due = time.monotonic()
    os.unlink(LINK)
    os.close(master)


while True:
    if os.path.exists(STOP):
        time.sleep(0.005)
    else:
        serve()
