#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Feeds isobard from a barometer that it has no driver for: one that prints "hPa degC" a line.

    my-sensor | ./feeder.py                   # isobard on this machine, barometer.source = "datagram"
    my-sensor | ./feeder.py 192.168.1.20      # on another one

The same way IMUs ("imu,SEQ,T_NS,gx,gy,gz,ax,ay,az") and wheels ("wheel,SEQ,T_NS,vx,vy,wz") come in; T_NS 0: stamped on
arrival."""
import socket
import sys

address = (sys.argv[1] if len(sys.argv) > 1 else "127.0.0.1", 7373)
out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for sequence, line in enumerate(sys.stdin):
    hectopascal, celsius = (float(word) for word in line.split())
    out.sendto(f"baro,{sequence},0,{100.0 * hectopascal:.2f},{celsius:.2f}".encode(), address)
