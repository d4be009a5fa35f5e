"""Writes the messages of a ROS 1 bag as ROS 2 would: CDR from ROS 1's own description of each message's fields."""
import os
import re
import sqlite3
import struct

import rosbag

FORMATS = {"bool": "B", "byte": "b", "uint8": "B", "int8": "b", "uint16": "H", "int32": "i", "uint32": "I",
           "float32": "f", "float64": "d"}


class Cdr:
    def __init__(self, order):
        self.order, self.data = order, b""

    def number(self, kind, value):
        size = struct.calcsize("=" + FORMATS[kind])
        self.data += b"\0" * (-len(self.data) % size) + struct.pack(self.order + FORMATS[kind], value)

    def field(self, kind, value):
        many = re.fullmatch(r"(.+)\[(\d*)\]", kind)
        if many:
            if not many[2]:
                self.number("uint32", len(value))
            if many[1] == "uint8":
                self.data += bytes(value)
                return
            for one in value:
                self.field(many[1], one)
        elif kind == "string":
            self.number("uint32", len(value.encode()) + 1)
            self.data += value.encode() + b"\0"
        elif kind == "time":
            self.number("int32", value.secs)
            self.number("uint32", value.nsecs)
        elif kind in FORMATS:
            self.number(kind, value)
        else:
            self.message(value)

    def message(self, message):
        for name, kind in zip(message.__slots__, message._slot_types):
            if name != "seq":  # ROS 2's header has none
                self.field(kind, getattr(message, name))


def cdr(message, order):
    out = Cdr(order)
    out.message(message)
    return (b"\0\1\0\0" if order == "<" else b"\0\0\0\0") + out.data


def messages_of(path, order):
    """Time in ns, topic, type and bytes of each."""
    with rosbag.Bag(path) as bag:
        return [(time.to_nsec(), topic, message._type.replace("/", "/msg/"), cdr(message, order))
                for topic, message, time in bag.read_messages()]


def write_sqlite(messages, folder):
    """In two files, numbered past nine."""
    os.makedirs(folder)
    half = len(messages) // 2
    for number, part in [(9, messages[:half]), (10, messages[half:])]:
        base = sqlite3.connect(f"{folder}/bag_{number}.db3")
        base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
                     "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
        base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
                     "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        numbers = {}
        for time, topic, kind, data in part:
            if topic not in numbers:
                numbers[topic] = len(numbers) + 1
                base.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (numbers[topic], topic, kind))
            base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (numbers[topic], time, data))
        base.commit()
        base.close()


def record(kind, data):
    return struct.pack("<BQ", kind, len(data)) + data


def string(text):
    return struct.pack("<I", len(text)) + text.encode()


def write_mcap(messages, path, compress=None):
    """In chunks of 100 messages; `compress` makes zstd of bytes."""
    with open(path, "xb") as file:
        file.write(b"\x89MCAP0\r\n" + record(1, string("ros2") + string("test")))
        numbers = {}
        for begin in range(0, len(messages), 100):
            part, records = messages[begin:begin + 100], b""
            for time, topic, kind, data in part:
                if topic not in numbers:
                    number = numbers[topic] = len(numbers) + 1
                    records += record(3, struct.pack("<H", number) + string(kind) + string("ros2msg") + string(""))
                    records += record(4, struct.pack("<HH", number, number) + string(topic) + string("cdr") +
                                      struct.pack("<I", 0))
                records += record(5, struct.pack("<HIQQ", numbers[topic], 0, time, time) + data)
            packed = compress(records) if compress else records
            file.write(record(6, struct.pack("<QQQI", part[0][0], part[-1][0], len(records), 0) +
                              string("zstd" if compress else "") + struct.pack("<Q", len(packed)) + packed))
        file.write(record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0)) + b"\x89MCAP0\r\n")
