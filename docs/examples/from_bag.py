#!/usr/bin/python3
"""Makes of a ROS bag what depthgrid maps: a CARMEN log of a laser, or a TUM folder of a depth camera.

    apt-get install python3-numpy                                # for a ROS 2 bag: a folder, a .db3 or a .mcap
    apt-get install python3-zstandard python3-lz4                # for a ROS 2 bag that is compressed
    apt-get install python3-rosbag python3-sensor-msgs python3-nav-msgs python3-tf2-msgs python3-numpy  # of ROS 1
    python3 from_bag.py drive.bag                                # which topics it has
    python3 from_bag.py drive.bag --scan /scan --odom /odom -o robot.log
    python3 from_bag.py drive.bag --depth /camera/depth/image_raw --odom /odom -o sequence

Poses are those of `--odom` (nav_msgs/Odometry), or, without it, of the frames `--odom-frame` and `--base-frame` in /tf.
Where the sensor is on the robot tells /tf_static or /tf; `--mount X Y YAW` (m, degrees) for a laser that neither knows.
A bag of ROS 1 is read by ROS's own library, one of ROS 2 by ros2_bag.py, which lies beside this.
"""
import argparse
import bisect
import contextlib
import math
import os
import shlex
import shutil
import struct
import sys
import tempfile
import zlib

sys.dont_write_bytecode = True  # no __pycache__ beside the examples
MISSING = ""
try:
    import numpy as np
    import ros2_bag
except ImportError as error:  # --help does without
    MISSING = f"{error}: apt-get install python3-numpy, for /usr/bin/python3"

# A gap in the poses that no straight line is drawn across.
MOST_GAP_S = 0.5
DEPTH_SCALE = 5000  # units a metre of what comes in metres
FARTHEST_UNITS = 65534  # 65535 is no depth, as for depthgrid (mapper/io/png.cc)


class BadInput(Exception):
    """What is wrong with what the user gave: one line."""


def seconds(stamp):
    return stamp.secs + stamp.nsecs * 1e-9


def decimal(stamp):
    """All nine digits, which a float has not."""
    return f"{stamp.secs}.{stamp.nsecs:09d}"


def matrix(position, quaternion):
    """The 4x4 of a position and a unit quaternion x y z w."""
    x, y, z, w = quaternion
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = position
    return pose


def pose_of(position, rotation):
    """Of a geometry_msgs position and quaternion; None where these are none."""
    position = np.array([position.x, position.y, position.z])
    quaternion = np.array([rotation.x, rotation.y, rotation.z, rotation.w])
    length = np.linalg.norm(quaternion)
    if not np.isfinite(position).all() or not abs(length - 1) < 0.01:
        return None
    return matrix(position, quaternion / length)


def quaternion_of(rotation):
    """x y z w of a 3x3, by the largest of the four, so that none is divided by little."""
    r = rotation
    four = np.array([1 + r[0, 0] - r[1, 1] - r[2, 2], 1 - r[0, 0] + r[1, 1] - r[2, 2],
                     1 - r[0, 0] - r[1, 1] + r[2, 2], 1 + r[0, 0] + r[1, 1] + r[2, 2]])
    k = int(np.argmax(four))
    products = np.array([
        [four[0], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
        [r[0, 1] + r[1, 0], four[1], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
        [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], four[2], r[1, 0] - r[0, 1]],
        [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], four[3]]])
    return products[k] / np.linalg.norm(products[k])


def between(a, b, share):
    """The pose at this share of the way from a to b, turning about one axis."""
    qa, qb = quaternion_of(a[:3, :3]), quaternion_of(b[:3, :3])
    if qa @ qb < 0:
        qb = -qb
    angle = math.acos(min(1.0, qa @ qb))
    if angle < 1e-6:
        q = qa + share * (qb - qa)
    else:
        q = math.sin((1 - share) * angle) * qa + math.sin(share * angle) * qb
    return matrix(a[:3, 3] + share * (b[:3, 3] - a[:3, 3]), q / np.linalg.norm(q))


def messages(bag, path, topics):
    """Those of the topics, each as topic, message and time."""
    try:
        yield from bag.read_messages(topics=topics)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error


class Track:
    """Poses by time."""

    def __init__(self):
        self.rows = []
        self.is_static = False
        self.sorted = True

    def add(self, stamp_s, pose):
        if self.rows and stamp_s < self.rows[-1][0]:
            self.sorted = False
        self.rows.append((stamp_s, pose))

    def at(self, stamp_s):
        """None before the first, behind the last, and in a gap."""
        if not self.sorted:
            self.rows.sort(key=lambda row: row[0])
            self.sorted = True
        if self.is_static:
            return self.rows[-1][1]
        after = bisect.bisect_left(self.rows, stamp_s, key=lambda row: row[0])
        if after < len(self.rows) and self.rows[after][0] == stamp_s:
            return self.rows[after][1]
        if after in (0, len(self.rows)):
            return None
        (t0, a), (t1, b) = self.rows[after - 1], self.rows[after]
        return between(a, b, (stamp_s - t0) / (t1 - t0)) if t1 - t0 <= MOST_GAP_S else None


class Frames:
    """What /tf and /tf_static say: each frame's pose in its parent."""

    def __init__(self):
        self.parent = {}
        self.track = {}

    def add(self, message, is_static):
        for one in message.transforms:
            child = one.child_frame_id.lstrip("/")
            pose = pose_of(one.transform.translation, one.transform.rotation)
            if pose is None:
                continue
            track = self.track.setdefault(child, Track())
            track.is_static = track.is_static or is_static
            track.add(seconds(one.header.stamp), pose)
            self.parent[child] = one.header.frame_id.lstrip("/")

    def chain(self, frame):
        names = [frame]
        while names[-1] in self.parent and len(names) < 100:
            names.append(self.parent[names[-1]])
        return names

    def joins(self, top, bottom):
        return bool(set(self.chain(top)) & set(self.chain(bottom)))

    def pose(self, top, bottom, stamp_s):
        """`bottom` in `top`; None where one of the poses on the way is not known at that time."""
        up, down = self.chain(top), self.chain(bottom)
        common = next(name for name in up if name in down)
        halves = []
        for names in (up, down):
            pose = np.eye(4)
            for name in names[:names.index(common)]:
                step = self.track[name].at(stamp_s)
                if step is None:
                    return None
                pose = step @ pose
            halves.append(pose)
        return np.linalg.inv(halves[0]) @ halves[1]


class Poses:
    """Where the sensor was in the odometry's frame."""

    def __init__(self, bag, arguments, of_topic):
        self.frames, self.odometry, self.odometry_child = Frames(), None, ""
        self.mount, self.base = None, arguments.base_frame
        topics = ["/tf", "/tf_static"] + ([arguments.odom] if arguments.odom else [])
        for topic, message, _ in messages(bag, arguments.bag, topics):
            if topic in ("/tf", "/tf_static"):
                self.frames.add(message, topic == "/tf_static")
                continue
            self.odometry = self.odometry or Track()
            self.odometry_child = message.child_frame_id.lstrip("/")
            pose = pose_of(message.pose.pose.position, message.pose.pose.orientation)
            if pose is not None:
                self.odometry.add(seconds(message.header.stamp), pose)
        if self.odometry is not None:
            self.base = self.base or self.odometry_child or "base_link"
        self.base = (self.base or "base_link").lstrip("/")
        self.odom = arguments.odom_frame.lstrip("/")
        if self.odometry is None and not self.frames.joins(self.odom, self.base):
            raise BadInput(f"{arguments.bag}: /tf joins no frame '{self.base}' to '{self.odom}': "
                           "name the odometry's topic with --odom, or --odom-frame and --base-frame")
        if arguments.mount is not None:
            x, y, yaw_deg = arguments.mount
            c, s = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))
            self.mount = np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, 0], [0, 0, 0, 1]])
        self.of_topic = of_topic

    def at(self, sensor_frame, stamp_s):
        base = (self.odometry.at(stamp_s) if self.odometry is not None
                else self.frames.pose(self.odom, self.base, stamp_s))
        mount = self.mount if self.mount is not None else self.mount_of(sensor_frame.lstrip("/"), stamp_s)
        return None if base is None or mount is None else base @ mount

    def mount_of(self, sensor, stamp_s):
        if sensor == self.base:
            return np.eye(4)
        if not self.frames.joins(self.base, sensor):
            raise BadInput(f"{self.of_topic}: /tf does not say where '{sensor}' is on '{self.base}': "
                           "name the robot's frame with --base-frame, or for a laser state --mount X Y YAW")
        return self.frames.pose(self.base, sensor, stamp_s)


def laser_line(message, pose, first_s):
    """ROBOTLASER1, its pose the laser's own."""
    ranges = np.array(message.ranges, dtype=float)
    start, step = message.angle_min, message.angle_increment
    # Upside down, or turning to the right: from right to left as a CARMEN log has them.
    if pose[2, 2] < 0:
        start, step = -start, -step
    if step < 0:
        start, step, ranges = start + step * (len(ranges) - 1), -step, ranges[::-1]
    most = message.range_max
    # -infinity is too near and NaN a fault: 0 is no data.
    ranges = np.where(ranges >= most, most, np.nan_to_num(ranges, nan=0.0, posinf=most, neginf=0.0))
    ranges[(ranges < message.range_min) | (ranges < 0)] = 0.0
    x, y, yaw = pose[0, 3], pose[1, 3], math.atan2(pose[1, 0], pose[0, 0])
    text = f"ROBOTLASER1 0 {start:.9g} {step * (len(ranges) - 1):.9g} {step:.9g} {most:.9g} 0 0 {len(ranges)} "
    text += " ".join(f"{r:.4f}" for r in ranges)
    at = f"{x:.6f} {y:.6f} {yaw:.8f}"
    stamp = decimal(message.header.stamp)
    return f"{text} 0 {at} {at} 0 0 0 0 0 {stamp} bag {seconds(message.header.stamp) - first_s:.6f}\n"


def write_log(bag, arguments, path):
    poses = Poses(bag, arguments, arguments.scan)
    first_s, written, without_pose = None, 0, 0
    with open(path, "x", encoding="ascii") as log:
        for _, message, _ in messages(bag, arguments.bag, [arguments.scan]):
            stamp_s = seconds(message.header.stamp)
            first_s = stamp_s if first_s is None else first_s
            pose = poses.at(message.header.frame_id, stamp_s)
            if pose is None:
                without_pose += 1
                continue
            log.write(laser_line(message, pose, first_s))
            written += 1
    return written, without_pose


def png16(image):
    """A 16-bit grey PNG."""
    rows = b"".join(b"\0" + row.tobytes() for row in image.astype(">u2"))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 16, 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 1)) +
            chunk(b"IEND", b""))


def depth_png(topic, message):
    """The image as a PNG, and its units a metre."""
    if message._type == "sensor_msgs/CompressedImage":
        if "compressedDepth" not in message.format or not message.format.startswith("16UC1"):
            raise BadInput(f"{topic}: format is '{message.format}', must be '16UC1; compressedDepth'")
        return bytes(message.data[12:]), 1000  # behind the plugin's own header
    kinds = {"16UC1": (np.uint16, 1000), "mono16": (np.uint16, 1000), "32FC1": (np.float32, DEPTH_SCALE)}
    if message.encoding not in kinds:
        raise BadInput(f"{topic}: encoding is '{message.encoding}', must be 16UC1, mono16 or 32FC1")
    kind, scale = kinds[message.encoding]
    kind = np.dtype(kind).newbyteorder(">" if message.is_bigendian else "<")
    stamp = decimal(message.header.stamp)
    if message.step < message.width * kind.itemsize:
        raise BadInput(f"{topic}: the image of {stamp} has rows of {message.step} bytes, must have "
                       f"{message.width * kind.itemsize} or more")
    if len(message.data) != message.height * message.step:
        raise BadInput(f"{topic}: the image of {stamp} has {len(message.data)} bytes, must have "
                       f"{message.height} rows of {message.step}")
    rows = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
    image = rows[:, :message.width * kind.itemsize].copy().view(kind)
    if message.encoding == "32FC1":
        # What is too far remains so: free space up to the farthest that the image can say.
        units = np.nan_to_num(image.astype(float), nan=0.0, posinf=FARTHEST_UNITS, neginf=0.0) * scale
        image = np.rint(np.clip(units, 0, FARTHEST_UNITS))
    return png16(image), scale


def camera_yaml(info, scale, topic):
    text = f"width: {info.width}\nheight: {info.height}\n"
    k = info.K
    text += f"fx: {k[0]!r}\nfy: {k[4]!r}\ncx: {k[2]!r}\ncy: {k[5]!r}\ndepth_scale: {scale}\n"
    d = list(info.D)[:5]
    if info.distortion_model not in ("", "plumb_bob", "rational_polynomial"):
        raise BadInput(f"{topic}: distortion_model is '{info.distortion_model}', must be plumb_bob")
    if any(list(info.D)[5:]):
        raise BadInput(f"{topic}: the distortion has {len(info.D)} numbers, must have 5: rectify the images first")
    if any(d):
        text += "distortion: [" + ", ".join(repr(x) for x in d + [0.0] * (5 - len(d))) + "]\n"
    return text


def write_folder(bag, arguments, path):
    poses = Poses(bag, arguments, arguments.depth)
    info_topic = arguments.info or os.path.dirname(arguments.depth) + "/camera_info"
    info = next((m for _, m, _ in messages(bag, arguments.bag, [info_topic])), None)
    if info is None:
        raise BadInput(f"{arguments.bag}: holds no message of {info_topic}: name the camera's with --info")
    os.makedirs(path + "/depth")
    written, without_pose, scale, stamps = 0, 0, None, set()
    with open(path + "/depth.txt", "x", encoding="ascii") as list_of_images, \
         open(path + "/odometry.txt", "x", encoding="ascii") as rows:
        for _, message, _ in messages(bag, arguments.bag, [arguments.depth]):
            png, scale = depth_png(arguments.depth, message)
            stamp = decimal(message.header.stamp)
            if stamp in stamps:
                raise BadInput(f"{arguments.depth}: two images have the stamp {stamp}, must have one each")
            stamps.add(stamp)
            with open(f"{path}/depth/{stamp}.png", "xb") as file:
                file.write(png)
            list_of_images.write(f"{stamp} depth/{stamp}.png\n")
            pose = poses.at(message.header.frame_id, seconds(message.header.stamp))
            if pose is None:
                without_pose += 1
                continue
            numbers = [*pose[:3, 3], *quaternion_of(pose[:3, :3])]
            rows.write(stamp + "".join(f" {number:.9f}" for number in numbers) + "\n")
            written += 1
    if scale is not None:
        with open(path + "/camera.yaml", "x", encoding="ascii") as file:
            file.write(camera_yaml(info, scale, info_topic))
    return written, without_pose


def topics_of(bag):
    return {topic: (about.msg_type, about.message_count)
            for topic, about in bag.get_type_and_topic_info().topics.items()}


def require_topic(bag, arguments, option, topic, kinds):
    topics = topics_of(bag)
    if topic not in topics:
        there = [name for name, (kind, _) in topics.items() if kind in kinds]
        raise BadInput(f"{option}: {arguments.bag} has no topic {topic}; of that kind are: "
                       + (", ".join(there) or "none"))
    if topics[topic][0] not in kinds:
        raise BadInput(f"{option}: {topic} is {topics[topic][0]}, must be {' or '.join(kinds)}")


def convert(bag, arguments):
    if bool(arguments.scan) == bool(arguments.depth):
        raise BadInput("--scan, --depth: one of them must be given")
    if not arguments.output:
        raise BadInput("-o: must be given")
    if os.path.lexists(arguments.output):
        raise BadInput(f"{arguments.output}: is there already")
    if arguments.depth and arguments.mount:
        raise BadInput("--mount: is of a laser; where a camera is /tf must say")
    if arguments.odom:
        require_topic(bag, arguments, "--odom", arguments.odom, ["nav_msgs/Odometry"])
    if arguments.scan:
        require_topic(bag, arguments, "--scan", arguments.scan, ["sensor_msgs/LaserScan"])
        command = ["depthgrid", "map", arguments.output, "-o", "map"]
    else:
        require_topic(bag, arguments, "--depth", arguments.depth,
                      ["sensor_msgs/Image", "sensor_msgs/CompressedImage"])
        command = ["depthgrid", "map", arguments.output, "--poses", arguments.output + "/odometry.txt", "--up", "z",
                   "-o", "map"]
    # Under its name when all of it is there.
    work = tempfile.mkdtemp(prefix=".from_bag.", dir=os.path.dirname(os.path.abspath(arguments.output)))
    try:
        write = write_log if arguments.scan else write_folder
        written, without_pose = write(bag, arguments, work + "/result")
        if without_pose:
            topic = arguments.scan or arguments.depth
            print(f"from_bag.py: {arguments.bag}: of {topic}, {without_pose} have no pose at their time", file=sys.stderr)
        if written == 0:
            raise BadInput(f"{arguments.bag}: no pose is known at the time of any scan or image")
        os.rename(work + "/result", arguments.output)
    finally:
        shutil.rmtree(work)
    print(f"{written} written; next: {shlex.join(command)}")


@contextlib.contextmanager
def opened(path):
    """The bag at a path, of either ROS."""
    if ros2_bag.is_one(path):
        try:
            bag = ros2_bag.Bag(path)
        except OSError as error:
            raise BadInput(f"{error.filename or path}: cannot be read: {error.strerror}") from error
        with bag:
            for name in bag.unfinished():
                print(f"from_bag.py: {name}: was not closed, what its end held may be missing", file=sys.stderr)
            yield bag
        return
    try:
        import rosbag
    except ImportError as error:
        raise BadInput(f"{path}: of a ROS 1 bag: {error}: apt-get install python3-rosbag python3-sensor-msgs "
                       "python3-nav-msgs python3-tf2-msgs, for /usr/bin/python3") from error
    try:
        bag = rosbag.Bag(path)
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:  # of what should be its first line
        raise BadInput(f"{path}: is no ROS 1 bag; those of ROS 2 are folders, .db3 or .mcap") from error
    except rosbag.ROSBagException as error:
        raise BadInput(f"{path}: {error}") from error
    try:
        with bag:
            yield bag
    except rosbag.ROSBagException as error:
        raise BadInput(f"{path}: {error}") from error


def main():
    about, _, more = __doc__.partition("\n\n")
    parser = argparse.ArgumentParser(description=about, epilog=more,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bag")
    parser.add_argument("--scan", metavar="TOPIC", help="sensor_msgs/LaserScan")
    parser.add_argument("--depth", metavar="TOPIC", help="sensor_msgs/Image, 16UC1 (mm) or 32FC1 (m)")
    parser.add_argument("--info", metavar="TOPIC", help="its CameraInfo (default: camera_info beside it)")
    parser.add_argument("--odom", metavar="TOPIC", help="nav_msgs/Odometry (default: /tf)")
    parser.add_argument("--odom-frame", default="odom", help="of /tf (default: odom)")
    parser.add_argument("--base-frame", default="", help="the robot's (default: the odometry's child, or base_link)")
    parser.add_argument("--mount", nargs=3, type=float, metavar=("X", "Y", "YAW"),
                        help="of the laser on the robot: m forward, m left, degrees to the left")
    parser.add_argument("-o", "--output", help="the log, or the folder, to write")
    arguments = parser.parse_args()
    if MISSING:
        print(f"from_bag.py: {MISSING}", file=sys.stderr)
        return 2
    try:
        with opened(arguments.bag) as bag:
            if not (arguments.scan or arguments.depth or arguments.output):
                for topic, (kind, count) in sorted(topics_of(bag).items()):
                    print(f"{topic}  {kind}  {count}")
                return 0
            convert(bag, arguments)
        return 0
    except (BadInput, ros2_bag.BagError) as error:
        print(f"from_bag.py: {error}", file=sys.stderr)
    except OSError as error:
        # One of reading is a BadInput by now.
        print(f"from_bag.py: {arguments.output}: cannot be written: {error.strerror}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
