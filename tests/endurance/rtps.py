# SPDX-License-Identifier: BSD-3-Clause
"""RTPS datagrams (the wire protocol of DDS) on loopback: recorded, mutated, sent. Needs root."""

import os
import socket
import struct
import time
from pathlib import Path

HEADER = 20  # of an RTPS message: magic, version, vendor, GUID prefix
SUBMESSAGES = (0x01, 0x06, 0x07, 0x08, 0x09, 0x0c, 0x0d, 0x0e, 0x12, 0x13, 0x15, 0x16, 0x30, 0x31, 0x32, 0x33, 0x34)


def record(seconds, most=20_000):
    """The distinct RTPS datagrams that appear on loopback."""
    tap = socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM, socket.htons(0x0800))
    tap.bind(("lo", 0x0800))
    tap.settimeout(0.1)
    found, end = set(), time.monotonic() + seconds
    while time.monotonic() < end and len(found) < most:
        try:
            packet = tap.recv(65536)
        except socket.timeout:
            continue
        payload = packet[4 * (packet[0] & 15) + 8:]
        if packet[9] == socket.IPPROTO_UDP and payload[:4] == b"RTPS" and len(payload) > HEADER:
            found.add(payload)
    tap.close()
    return sorted(found)


def unicast_ports(pid):
    """Ports on which a DDS process receives datagrams that are meant for it alone."""
    inodes = set()
    for descriptor in Path(f"/proc/{pid}/fd").iterdir():
        try:
            link = os.readlink(descriptor)
        except OSError:
            continue
        if link.startswith("socket:["):
            inodes.add(link[8:-1])
    ports = set()
    for line in Path(f"/proc/{pid}/net/udp").read_text().splitlines()[1:]:
        fields = line.split()
        port = int(fields[1].split(":")[1], 16)
        if fields[9] in inodes and port % 250 >= 160 and port >= 7400:  # 7400 + 250 domain + 10 + 2 index
            ports.add(port)
    return sorted(ports)


def split(message):
    """The submessages of a message, each with its header of 4 bytes."""
    at, parts = HEADER, []
    while at + 4 <= len(message):
        order = "<H" if message[at + 1] & 1 else ">H"
        length = struct.unpack_from(order, message, at + 2)[0]
        if length == 0 or at + 4 + length > len(message):
            length = len(message) - at - 4
        parts.append(bytearray(message[at:at + 4 + length]))
        at += 4 + length
    return parts


def with_changed_bytes(message, choose):
    for _ in range(choose.randint(1, 8)):
        at = choose.randrange(4, len(message))
        message[at] = choose.choice((0, 0xff, 0x7f, 0x80, message[at] ^ (1 << choose.randrange(8)), choose.randrange(256)))
    return message


def with_changed_words(message, choose):
    """Lengths, counts and sequence numbers are aligned words."""
    for _ in range(choose.randint(1, 3)):
        at = 4 * choose.randrange(1, max(2, len(message) // 4))
        value = choose.choice((0, 1, 2, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0x80000000, 0xfffffff0, 0xffffffff))
        message[at:at + 4] = struct.pack("<I", value)
    return message[:65000]


def with_changed_submessages(message, choose, others):
    parts = split(message) or [bytearray(4)]
    for _ in range(choose.randint(1, 3)):
        what, at = choose.randrange(7), choose.randrange(len(parts))
        if what == 0:
            parts[at][0] = choose.choice(SUBMESSAGES)
        elif what == 1:
            parts[at][1] ^= 1 << choose.randrange(8)
        elif what == 2:
            parts[at][2:4] = struct.pack("<H", choose.choice((0, 1, 4, 20, len(parts[at]), 0x7fff, 0xffff)))
        elif what == 3:
            parts.insert(at, bytearray(parts[choose.randrange(len(parts))]))
        elif what == 4:
            parts.insert(at, bytearray(choose.choice(split(choose.choice(others)) or [bytearray(4)])))
        elif what == 5 and len(parts) > 1:
            del parts[at]
        else:
            del parts[at][choose.randrange(len(parts[at])):]
            parts[at] += bytes(max(0, 4 - len(parts[at])))
    return bytearray(b"".join([bytes(message[:HEADER]), *parts])[:65000])


def mutated(recorded, choose):
    """One of the recorded datagrams with some bytes, lengths or submessages changed, or its end cut off."""
    message = bytearray(choose.choice(recorded))
    kind = choose.randrange(8)
    if kind < 3:
        message = with_changed_bytes(message, choose)
    elif kind < 5:
        message = with_changed_words(message, choose)
    elif kind < 7:
        message = with_changed_submessages(message, choose, recorded)
    else:
        message = message[:choose.randrange(4, len(message))]
    return bytes(message)
