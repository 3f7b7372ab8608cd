#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Passes lidar packets and sample datagrams on to isobard, with an event on the way.

unsteady_relay.py EVENT AFTER_S [SECONDS]   ports 12368 and 17373 to 2368 and 7373 of 127.0.0.1; ends with SIGTERM
  lost    all is lost for SECONDS
  bunch   all is late, up to SECONDS, and comes in one bunch
  stall   a virtual machine under load: half of SECONDS are lost, the next 2 s are all late by SECONDS, then it recovers
  lidar   the lidar restarts: off for SECONDS, then its clock begins at 0
  imu     the IMU restarts: off for SECONDS, then its numbers and its clock begin at 0
  power   both lose their power and restart: the IMU after 1 s, the lidar after SECONDS
"""
import heapq
import select
import socket
import struct
import sys
import time

event, after_s = sys.argv[1], float(sys.argv[2])
length_s = float(sys.argv[3]) if len(sys.argv) > 3 else 0.0


def listen(port):
    receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 23)
    receiver.bind(("127.0.0.1", port))
    return receiver


routes = {listen(12368): 2368, listen(17373): 7373}
sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
lidar_zero_us = imu_zero = None


def restart_lidar(data):
    global lidar_zero_us
    (stamp_us,) = struct.unpack_from("<I", data, 1200)
    lidar_zero_us = stamp_us if lidar_zero_us is None else lidar_zero_us
    return data[:1200] + struct.pack("<I", (stamp_us - lidar_zero_us) % 3_600_000_000) + data[1204:]


def restart_imu(data):
    global imu_zero
    fields = data.split(b",", 3)
    number, stamp_ns = int(fields[1]), int(fields[2])
    imu_zero = (number, stamp_ns) if imu_zero is None else imu_zero
    return b"%s,%d,%d,%s" % (fields[0], number - imu_zero[0], stamp_ns - imu_zero[1] + 10**9, fields[3])


def passed(data, is_lidar, t):
    """When the datagram goes on, in seconds after the first one, and what it holds then; None: lost."""
    since_s = t - after_s
    if since_s < 0:
        return t, data
    if event == "lost":
        return (t, data) if since_s >= length_s else None
    if event == "bunch":
        return max(t, after_s + length_s), data
    if event == "stall":
        if since_s < length_s / 2:
            return None
        return (min(t + length_s, after_s + 1.5 * length_s + 2), data) if since_s < length_s / 2 + 2 else (max(t, after_s + 1.5 * length_s + 2), data)
    is_imu = data.startswith(b"imu,")
    if is_lidar and event in ("lidar", "power") and len(data) == 1206:
        return (t, restart_lidar(data)) if since_s >= length_s else None
    if is_imu and event in ("imu", "power"):
        return (t, restart_imu(data)) if since_s >= (1.0 if event == "power" else length_s) else None
    return t, data


start_s = None
waiting = []
count = 0
while True:
    now_s = time.monotonic()
    due_s = start_s + waiting[0][0] - now_s if waiting else 1.0
    readable, _, _ = select.select(list(routes), [], [], max(0.0, due_s))
    now_s = time.monotonic()
    for receiver in readable:
        data = receiver.recv(2048)
        start_s = now_s if start_s is None else start_s
        goes_on = passed(data, routes[receiver] == 2368, now_s - start_s)
        if goes_on is not None:
            count += 1
            heapq.heappush(waiting, (goes_on[0], count, goes_on[1], routes[receiver]))
    while waiting and start_s + waiting[0][0] <= now_s:
        _, _, data, port = heapq.heappop(waiting)
        sender.sendto(data, ("127.0.0.1", port))
