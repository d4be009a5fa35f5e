"""Reads a ROS 2 bag, with Python's own library and numpy, as `rosbag` reads one of ROS 1: for from_bag.py.

A bag is a folder that `ros2 bag record` wrote, or one of its files: SQLite (.db3) or MCAP (.mcap; its chunks may be
compressed by zstd or lz4: python3-zstandard, python3-lz4). Formats:
    https://github.com/ros2/rosbag2 (rosbag2_storage_sqlite3), https://mcap.dev/spec,
    CDR: OMG DDS-RTPS 2.3, section 10, as rmw writes it (plain, either byte order).
Messages come in the order of the file's times and have the names of ROS 1's fields.
"""
import os
import re
import sqlite3
import struct
import types

import numpy as np


class BagError(Exception):
    """What is wrong with a bag: one line."""


# As ROS 2's .msg files have them (common_interfaces, humble to jazzy), with the names of ROS 1 for what changed its own.
SCHEMAS = {
    "builtin_interfaces/Time": "int32 secs, uint32 nsecs",
    "std_msgs/Header": "builtin_interfaces/Time stamp, string frame_id",
    "geometry_msgs/Vector3": "float64 x, float64 y, float64 z",
    "geometry_msgs/Quaternion": "float64 x, float64 y, float64 z, float64 w",
    "geometry_msgs/Transform": "geometry_msgs/Vector3 translation, geometry_msgs/Quaternion rotation",
    "geometry_msgs/Pose": "geometry_msgs/Vector3 position, geometry_msgs/Quaternion orientation",
    "geometry_msgs/PoseWithCovariance": "geometry_msgs/Pose pose, float64[36] covariance",
    "geometry_msgs/TransformStamped":
        "std_msgs/Header header, string child_frame_id, geometry_msgs/Transform transform",
    "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms",
    # The twist behind it is not read.
    "nav_msgs/Odometry": "std_msgs/Header header, string child_frame_id, geometry_msgs/PoseWithCovariance pose",
    "sensor_msgs/LaserScan":
        "std_msgs/Header header, float32 angle_min, float32 angle_max, float32 angle_increment, "
        "float32 time_increment, float32 scan_time, float32 range_min, float32 range_max, float32[] ranges, "
        "float32[] intensities",
    "sensor_msgs/Image":
        "std_msgs/Header header, uint32 height, uint32 width, string encoding, uint8 is_bigendian, uint32 step, "
        "uint8[] data",
    "sensor_msgs/CompressedImage": "std_msgs/Header header, string format, uint8[] data",
    # Binning and region of interest are not read.
    "sensor_msgs/CameraInfo":
        "std_msgs/Header header, uint32 height, uint32 width, string distortion_model, float64[] D, float64[9] K, "
        "float64[9] R, float64[12] P",
}
NUMBERS = {"uint8": "B", "int32": "i", "uint32": "I", "float32": "f", "float64": "d"}


class Cdr:
    """One message's bytes, read from the front."""

    def __init__(self, data):
        if len(data) < 4 or data[0] != 0 or data[1] not in (0, 1):
            raise BagError("a message does not begin as plain CDR does")
        self.data, self.at, self.order = memoryview(data)[4:], 0, ">" if data[1] == 0 else "<"

    def take(self, size, alignment=1):
        begin = -(-self.at // alignment) * alignment
        if begin + size > len(self.data):
            raise BagError(f"a message of {len(self.data)} bytes ends within a field")
        self.at = begin + size
        return self.data[begin:self.at]

    def numbers(self, kind, count):
        size = struct.calcsize("=" + NUMBERS[kind])
        if kind == "uint8":
            return bytes(self.take(count))
        if count == 0:  # nothing is aligned for it
            return []
        return np.frombuffer(self.take(size * count, size), self.order + NUMBERS[kind]).tolist()

    def one(self, kind):
        if kind in NUMBERS:
            size = struct.calcsize("=" + NUMBERS[kind])
            return struct.unpack(self.order + NUMBERS[kind], self.take(size, size))[0]
        if kind == "string":
            return bytes(self.take(self.one("uint32"))).rstrip(b"\0").decode("utf-8", "replace")
        return self.message(kind)

    def message(self, kind):
        fields = types.SimpleNamespace(_type=kind)
        for field in SCHEMAS[kind].split(", "):
            of, name = field.split(" ")
            many = re.fullmatch(r"(.+)\[(\d*)\]", of)
            if not many:
                setattr(fields, name, self.one(of))
                continue
            of, count = many[1], int(many[2]) if many[2] else self.one("uint32")
            values = self.numbers(of, count) if of in NUMBERS else [self.one(of) for _ in range(count)]
            setattr(fields, name, values)
        return fields


def decompressed(how, data):
    if how == "":
        return data
    try:
        if how == "zstd":
            import zstandard
            try:
                return zstandard.ZstdDecompressor().decompressobj().decompress(data)
            except zstandard.ZstdError as error:
                raise BagError(f"zstd: {error}") from error
        if how == "lz4":
            import lz4.frame
            try:
                return lz4.frame.decompress(data)
            except RuntimeError as error:
                raise BagError(f"lz4: {error}") from error
    except ImportError as error:
        package = {"zstd": "python3-zstandard", "lz4": "python3-lz4"}[how]
        raise BagError(f"is compressed by {how}: {error}: apt-get install {package}, for /usr/bin/python3") from error
    raise BagError(f"is compressed by '{how}', must be zstd, lz4 or not at all")


class SqliteFile:
    """`ros2 bag record -s sqlite3`."""

    def __init__(self, path):
        self.path = path
        try:
            # Read only, without a journal beside it.
            self.base = sqlite3.connect("file:" + re.sub(r"[?#%]", lambda c: f"%{ord(c[0]):02x}", path) + "?mode=ro",
                                        uri=True)
            self.topics = {number: (name, kind, encoding) for number, name, kind, encoding in
                           self.base.execute("SELECT id, name, type, serialization_format FROM topics")}
            self.counts = dict(self.base.execute("SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id"))
        except sqlite3.Error as error:
            raise BagError(f"{path}: {error}") from error

    def is_finished(self):
        return True

    def messages(self, wanted):
        numbers = [number for number, topic in self.topics.items() if topic[0] in wanted]
        marks = ", ".join("?" * len(numbers))
        try:
            for number, data in self.base.execute(
                    f"SELECT topic_id, data FROM messages WHERE topic_id IN ({marks}) ORDER BY timestamp, id", numbers):
                if not isinstance(data, bytes):
                    raise BagError(f"{self.path}: a message of {self.topics[number][0]} is no bytes")
                yield number, data
        except sqlite3.Error as error:
            raise BagError(f"{self.path}: {error}") from error


class McapFile:
    """`ros2 bag record -s mcap`. What was not finished is read as far as it goes."""

    MAGIC = b"\x89MCAP0\r\n"
    SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END, FOOTER = 3, 4, 5, 6, 15, 2

    def __init__(self, path):
        self.path, self.schemas, self.topics, self.counts = path, {}, {}, {}
        for number, _ in self.messages(None):
            self.counts[number] = self.counts.get(number, 0) + 1

    def is_finished(self):
        with open(self.path, "rb") as file:
            file.seek(-8, os.SEEK_END)
            return file.read() == self.MAGIC

    @staticmethod
    def string(record, at):
        size, = struct.unpack_from("<I", record, at)
        return bytes(record[at + 4:at + 4 + size]).decode("utf-8", "replace"), at + 4 + size

    def records_of_file(self):
        with open(self.path, "rb") as file:
            if file.read(8) != self.MAGIC:
                raise BagError(f"{self.path}: does not begin as MCAP does")
            left = os.fstat(file.fileno()).st_size - 8
            while left >= 9:
                kind, size = struct.unpack("<BQ", file.read(9))
                left -= 9 + size
                if left < 0 or kind in (self.DATA_END, self.FOOTER):
                    return
                if kind in (self.SCHEMA, self.CHANNEL, self.MESSAGE, self.CHUNK):
                    yield kind, file.read(size)
                else:
                    file.seek(size, os.SEEK_CUR)

    def records_of_chunk(self, chunk):
        how, at = self.string(chunk, 28)
        size, = struct.unpack_from("<Q", chunk, at)
        records, at = memoryview(decompressed(how, chunk[at + 8:at + 8 + size])), 0
        while at + 9 <= len(records):
            kind, size = struct.unpack_from("<BQ", records, at)
            yield kind, records[at + 9:at + 9 + size]
            at += 9 + size

    def read(self, kind, record, found):
        """Notes what a record says of topics; a message goes into `found`, with its time."""
        if kind == self.SCHEMA:
            number, = struct.unpack_from("<H", record)
            self.schemas[number] = self.string(record, 2)[0]
        elif kind == self.CHANNEL:
            number, schema = struct.unpack_from("<HH", record)
            topic, at = self.string(record, 4)
            self.topics[number] = (topic, self.schemas.get(schema, ""), self.string(record, at)[0])
        elif kind == self.MESSAGE:
            number, _, log_time, _ = struct.unpack_from("<HIQQ", record)
            if number not in self.topics:
                raise BagError("a message comes before its channel")
            found.append((log_time, number, record[22:]))

    def messages(self, wanted):
        try:
            for kind, record in self.records_of_file():
                found = []
                for one in self.records_of_chunk(record) if kind == self.CHUNK else [(kind, record)]:
                    self.read(*one, found)
                # A chunk's are in the order they came in, nearly that of their times.
                for _, number, data in sorted(found, key=lambda message: message[0]):
                    if wanted is None or self.topics[number][0] in wanted:
                        yield number, data
        except (BagError, struct.error) as error:
            text = str(error)
            raise BagError(text if text.startswith(self.path) else f"{self.path}: {text}") from error


def files_of(path):
    """Of a folder, in the order of their numbers: drive_2.mcap before drive_10.mcap."""
    names = [path]
    if os.path.isdir(path):
        names = sorted((name for name in os.listdir(path)
                        if re.search(r"\.(db3|mcap)(\.zstd|\.lz4)?$", name) and not name.startswith(".")),
                       key=lambda name: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)])
        if not names:
            raise BagError(f"{path}: holds no .db3 and no .mcap")
        names = [os.path.join(path, name) for name in names]
    for name in names:
        if name.endswith((".zstd", ".lz4")):
            raise BagError(f"{name}: is compressed as a whole: unpack it first, with {name.rsplit('.', 1)[1]} -d")
        with open(name, "rb") as file:
            yield McapFile(name) if file.read(8) == McapFile.MAGIC else SqliteFile(name)


def is_one(path):
    """Whether a path is of a ROS 2 bag."""
    return os.path.isdir(path) or bool(re.search(r"\.(db3|mcap)(\.zstd|\.lz4)?$", path))


class Bag:
    """What from_bag.py needs of `rosbag.Bag`."""

    def __init__(self, path):
        self.files = list(files_of(path))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for file in self.files:
            if isinstance(file, SqliteFile):
                file.base.close()

    def unfinished(self):
        """Files whose recording was cut off."""
        return [file.path for file in self.files if not file.is_finished()]

    @staticmethod
    def ros1_type(kind):
        return kind.replace("/msg/", "/")

    def get_type_and_topic_info(self):
        topics = {}
        for file in self.files:
            for number, (name, kind, _) in file.topics.items():
                count = file.counts.get(number, 0) + (topics[name].message_count if name in topics else 0)
                topics[name] = types.SimpleNamespace(msg_type=self.ros1_type(kind), message_count=count)
        return types.SimpleNamespace(topics=topics)

    def read_messages(self, topics):
        for file in self.files:
            for number, data in file.messages(set(topics)):
                name, kind, encoding = file.topics[number]
                if encoding != "cdr":
                    raise BagError(f"{file.path}: {name} is written as '{encoding}', must be cdr")
                if self.ros1_type(kind) not in SCHEMAS:
                    raise BagError(f"{file.path}: {name} is {kind}, which is not read")
                try:
                    if data[:4] == b"\x28\xb5\x2f\xfd":  # --compression-mode message
                        data = decompressed("zstd", bytes(data))
                    message = Cdr(data).message(self.ros1_type(kind))
                except BagError as error:
                    raise BagError(f"{file.path}: {name}: {error}") from error
                yield name, message, None
