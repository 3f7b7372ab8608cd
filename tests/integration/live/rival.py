#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A rival on the same network: from 127.0.0.2 it sends lidar packets of another room and forged samples.

Usage: rival.py LIDAR_PCAP SECONDS ADDRESS
"""
import socket
import struct
import sys
import time

pcap, seconds, address = sys.argv[1], float(sys.argv[2]), sys.argv[3]
data = open(pcap, "rb").read()
packets, at = [], 24
while at + 16 <= len(data):
    length = struct.unpack_from("<I", data, at + 8)[0]
    frame = data[at + 16 : at + 16 + length]
    at += 16 + length
    if len(frame) >= 1206:
        packets.append(bytearray(frame[-1206:]))
for packet in packets:  # turned by 123 degrees, and 7 s away by its own clock
    for block in range(12):
        azimuth = struct.unpack_from("<H", packet, 100 * block + 2)[0]
        struct.pack_into("<H", packet, 100 * block + 2, (azimuth + 12300) % 36000)
    stamp_us = struct.unpack_from("<I", packet, 1200)[0]
    struct.pack_into("<I", packet, 1200, (stamp_us + 7_000_000) % 3_600_000_000)

rival = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
rival.bind(("127.0.0.2", 0))
start = time.monotonic()
for i in range(10**9):
    now = time.monotonic() - start
    if now > seconds:
        break
    rival.sendto(packets[i % len(packets)], (address, 2368))
    if i % 4 == 0:
        rival.sendto(b"imu,%d,0,0,0,3.0,2.0,0,9.8\n" % i, (address, 7373))
        rival.sendto(b"wheel,%d,0,5.0,0,0\n" % i, (address, 7373))
        rival.sendto(b"baro,%d,0,%.1f,20\n" % (i, 98000.0 - 12.0 * now), (address, 7373))
        rival.sendto(b"base,%d,0,99000.0,20\n" % i, (address, 7373))
    time.sleep(max(0.0, start + i / 750.0 - time.monotonic()))
