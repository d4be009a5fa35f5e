#!/usr/bin/python3
"""run.py DEPTHGRID FROM_BAG FOLDER: bags as a robot writes them, made logs and folders, mapped and scored.

Exit code 77 (skipped) where ROS's Python packages are not installed.
"""
import contextlib
import filecmp
import io
import math
import os
import resource
import runpy
import shutil
import struct
import subprocess
import sys
import zlib

sys.dont_write_bytecode = True
try:
    import ros2_writer
    import zstandard
    import numpy as np
    import rosbag
    import rospy
    from geometry_msgs.msg import TransformStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import CameraInfo, Image, LaserScan
    from tf2_msgs.msg import TFMessage
except ImportError as missing:
    print(f"skipped: {missing} (Debian: python3-rosbag python3-sensor-msgs python3-nav-msgs python3-tf2-msgs python3-zstandard)")
    sys.exit(77)

DEPTHGRID, FROM_BAG, FOLDER = sys.argv[1:4]
FIRST_S = 1700000000
FRAMES, STEP_S = 240, 0.1
# A room of 8 x 6 m with a niche, as walls from point to point.
CORNERS = [(-4, -3), (4, -3), (4, 1), (5, 1), (5, 3), (-4, 3), (-4, -3)]


def stamp(seconds):
    whole = math.floor(seconds)
    return rospy.Time(FIRST_S + whole, round((seconds - whole) * 1e9))


def truth(seconds):
    """Of the base: once round an oval, looking ahead."""
    angle = 2 * math.pi * seconds / (FRAMES * STEP_S)
    x, y = 2.0 * math.cos(angle), 1.2 * math.sin(angle)
    return x, y, math.atan2(1.2 * math.cos(angle), -2.0 * math.sin(angle))


def drifted(seconds):
    """Of the odometry: turned more and more, .3 m off at the end."""
    x, y, yaw = truth(seconds)
    wrong = 0.15 * seconds / (FRAMES * STEP_S)
    return math.cos(wrong) * x - math.sin(wrong) * y, math.sin(wrong) * x + math.cos(wrong) * y, yaw + wrong


def times(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]


def distances(x, y, angles):
    """To the nearest wall, at each of the angles."""
    nearest, ray = np.full(len(angles), np.inf), (np.cos(angles), np.sin(angles))
    for (ax, ay), (bx, by) in zip(CORNERS, CORNERS[1:]):
        wall = (bx - ax, by - ay)
        cross = ray[0] * wall[1] - ray[1] * wall[0]
        cross[abs(cross) < 1e-12] = np.nan
        along = ((ax - x) * wall[1] - (ay - y) * wall[0]) / cross
        share = ((ax - x) * ray[1] - (ay - y) * ray[0]) / cross
        hit = (along > 0) & (0 <= share) & (share <= 1)
        nearest[hit] = np.minimum(nearest, along)[hit]
    return nearest


def transform(parent, child, seconds, pose, roll=0.0, quaternion=None, z=0.0):
    message = TransformStamped()
    message.header.stamp, message.header.frame_id, message.child_frame_id = stamp(seconds), parent, child
    message.transform.translation.x, message.transform.translation.y = pose[0], pose[1]
    message.transform.translation.z = z
    half, up = pose[2] / 2, roll / 2
    q = quaternion or (math.cos(half) * math.sin(up), math.sin(half) * math.sin(up),
                       math.sin(half) * math.cos(up), math.cos(half) * math.cos(up))
    rotation = message.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = q
    return message


def odometry(seconds):
    message = Odometry()
    message.header.stamp, message.header.frame_id, message.child_frame_id = stamp(seconds), "odom", "base_link"
    one = transform("", "", seconds, drifted(seconds)).transform
    message.pose.pose.position, message.pose.pose.orientation = one.translation, one.rotation
    return message


LASER = (0.3, 0.1, math.radians(20))


def laser_scan(seconds, upside_down):
    x, y, yaw = times(truth(seconds), LASER)
    message = LaserScan()
    message.header.stamp, message.header.frame_id = stamp(seconds), "laser"
    message.angle_min, message.angle_increment, message.range_min, message.range_max = -2.0, 0.01, 0.1, 7.0
    angles = message.angle_min + message.angle_increment * np.arange(401)
    message.angle_max = angles[-1]
    ranges = distances(x, y, yaw - angles if upside_down else yaw + angles)
    message.ranges = np.where(ranges < 7.0, ranges, np.inf).tolist()
    message.ranges[7] = math.nan
    return message


def write_laser_bag(path, compression, upside_down=False, with_odometry=True):
    with rosbag.Bag(path, "w", compression=compression) as bag:
        mounted = transform("base_link", "laser", 0, LASER, math.pi if upside_down else 0.0)
        bag.write("/tf_static", TFMessage([mounted]), stamp(0))
        for tick in range(2 * FRAMES):  # half a step after a scan each, so that poses lie between
            seconds = (tick + 0.5) * STEP_S / 2
            if with_odometry:
                bag.write("/odom", odometry(seconds), stamp(seconds))
            else:
                moved = transform("odom", "base_link", seconds, drifted(seconds))
                bag.write("/tf", TFMessage([moved]), stamp(seconds))
            if tick % 2 == 0:
                bag.write("/scan", laser_scan(tick * STEP_S / 2, upside_down), stamp(seconds))


WIDTH, HEIGHT, FOCAL = 160, 120, 120.0
CAMERA_Z = 0.6


def write_depth_bag(path):
    """A camera .2 m ahead of the base, .6 m high, that looks ahead; depth in mm."""
    u = (np.arange(WIDTH) - 79.5) / FOCAL
    down = (np.arange(HEIGHT) - 59.5) / FOCAL
    with rosbag.Bag(path, "w", compression="bz2") as bag:
        optical = (-0.5, 0.5, -0.5, 0.5)
        bag.write("/tf_static", TFMessage([
            transform("base_link", "camera_link", 0, (0.2, 0.0, 0.0), z=CAMERA_Z),
            transform("camera_link", "camera_optical", 0, (0.0, 0.0, 0.0), quaternion=optical)]), stamp(0))
        info = CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob", D=[0.0] * 5,
                          K=[FOCAL, 0, 79.5, 0, FOCAL, 59.5, 0, 0, 1])
        for frame in range(FRAMES):
            seconds = frame * STEP_S
            bag.write("/odom", odometry(seconds), stamp(seconds))
            x, y, yaw = times(truth(seconds), (0.2, 0.0, 0.0))
            walls = distances(x, y, yaw - np.arctan(u)) * np.cos(np.arctan(u))
            with np.errstate(divide="ignore"):
                floor = np.where(down > 0, CAMERA_Z / down, np.inf)
            depth = np.minimum(walls[None, :], floor[:, None])
            image = Image(height=HEIGHT, width=WIDTH, encoding="16UC1", step=2 * WIDTH,
                          data=np.rint(1000 * depth).astype("<u2").tobytes())
            image.header.stamp, image.header.frame_id = stamp(seconds), "camera_optical"
            info.header = image.header
            bag.write("/camera/depth/camera_info", info, stamp(seconds))
            bag.write("/camera/depth/image_raw", image, stamp(seconds))


def run(*command, exit_code=0):
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, text=True, check=False)
    if done.returncode != exit_code:
        sys.exit(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def from_bag(*arguments, exit_code=0):
    """As a user calls it."""
    return run(sys.executable, FROM_BAG, *arguments, exit_code=exit_code)


def from_bag_here(*arguments, exit_code=0):
    """The same in this process, which has loaded ROS's library already: that takes most of the time of a call."""
    out, err, code, argv = io.StringIO(), io.StringIO(), None, sys.argv
    sys.argv = [FROM_BAG, *arguments]
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            runpy.run_path(FROM_BAG, run_name="__main__")
    except SystemExit as end:
        code = end.code
    finally:
        sys.argv = argv
    done = subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())
    if code != exit_code:
        sys.exit(f"{FROM_BAG} {' '.join(arguments)}: exit code {code}\n{done.stdout}{done.stderr}")
    return done


def require(condition, what):
    if not condition:
        sys.exit(f"not so: {what}")


def mean_error_m(name, mount, is_camera):
    """Of the estimate in the frame where the odometry begins, which is the truth's."""
    rows = [[float(x) for x in line.split()] for line in open(f"{FOLDER}/{name}/trajectory_est.txt")
            if not line.startswith("#")]
    require(len(rows) > 0.95 * FRAMES, f"{name} has a pose for nearly every frame, {len(rows)}")
    errors = []
    for row in rows:
        x, y, _ = times(truth(row[0] - FIRST_S), mount)
        errors.append(math.hypot(row[1] - x, row[2] - y))
        require(not is_camera or abs(row[3] - CAMERA_Z) < 0.05, f"{name}: the camera's height, {row[3]}")
    return sum(errors) / len(errors)


def require_refusal(text, *arguments):
    done = from_bag_here(*arguments, exit_code=2)
    require(text in done.stderr and done.stderr.count("\n") == 1 and not done.stdout, f"{text}: {done.stderr}")
    require("refused" not in os.listdir(FOLDER), f"{arguments} leave nothing")


def require_far_depth_stays_far():
    """Of depth in metres: what is farther than the image can say, and no return, is no gap in it."""
    row = np.array([1.0, 13.2, np.inf, np.nan, -np.inf, -1.0, 13.1069, 0.0], "<f4")
    with rosbag.Bag(f"{FOLDER}/metres.bag", "w") as bag:
        info = CameraInfo(width=8, height=1, distortion_model="plumb_bob", D=[0.0] * 5, K=[8, 0, 3.5, 0, 8, 0, 0, 0, 1])
        for tick in range(3):
            bag.write("/odom", odometry(tick * STEP_S), stamp(tick * STEP_S))
            bag.write("/tf_static", TFMessage([transform("base_link", "eye", 0, (0.2, 0.0, 0.0))]), stamp(0))
            image = Image(height=1, width=8, encoding="32FC1", step=32, data=row.tobytes())
            image.header.stamp, image.header.frame_id = stamp(tick * STEP_S), "eye"
            bag.write("/eye/camera_info", info, stamp(tick * STEP_S))
            bag.write("/eye/image", image, stamp(tick * STEP_S))
    from_bag_here("metres.bag", "--depth", "/eye/image", "--odom", "/odom", "-o", "metres")
    name = sorted(os.listdir(f"{FOLDER}/metres/depth"))[0]
    with open(f"{FOLDER}/metres/depth/{name}", "rb") as file:
        png = file.read()
    size, = struct.unpack_from(">I", png, 33)  # behind the signature and IHDR
    units = np.frombuffer(zlib.decompress(png[41:41 + size])[1:], ">u2").tolist()
    require(units == [5000, 65534, 65534, 0, 0, 0, 65534, 0], f"units of metres: {units}")


def require_full_disk_is_told():
    """A file that may not grow stands for one on a full disk: told of the output, which is not there."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20000, limits[1]))
    try:
        require_refusal("refused: cannot be written: File too large",
                        "plain.bag", "--scan", "/scan", "--odom", "/odom", "-o", "refused")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def require_same_of_ros2():
    """Of the same messages as ROS 2 keeps them, the same log and folder."""
    laser, camera = (ros2_writer.messages_of(f"{FOLDER}/{name}.bag", order) for name, order in
                     [("plain", "<"), ("depth", ">")])
    ros2_writer.write_sqlite(laser, f"{FOLDER}/laser_sqlite")
    ros2_writer.write_mcap(laser, f"{FOLDER}/laser.mcap")
    ros2_writer.write_sqlite(camera, f"{FOLDER}/camera_sqlite")
    ros2_writer.write_mcap(camera, f"{FOLDER}/camera.mcap", zstandard.ZstdCompressor().compress)
    for bag in ["laser_sqlite", "laser.mcap"]:
        require(from_bag_here(bag).stdout == from_bag_here("plain.bag").stdout, f"{bag} has the topics of plain.bag")
        from_bag_here(bag, "--scan", "/scan", "--odom", "/odom", "-o", f"{bag}.log")
        require(filecmp.cmp(f"{FOLDER}/{bag}.log", f"{FOLDER}/plain.log", False), f"the log of {bag} is that of plain.bag")
    for bag in ["camera_sqlite", "camera.mcap"]:
        from_bag_here(bag, "--depth", "/camera/depth/image_raw", "--odom", "/odom", "-o", f"{bag}_sequence")
        names = ["camera.yaml", "depth.txt", "odometry.txt"]
        names += [f"depth/{name}" for name in os.listdir(f"{FOLDER}/sequence/depth")]
        same, *others = filecmp.cmpfiles(f"{FOLDER}/sequence", f"{FOLDER}/{bag}_sequence", names, False)
        require(len(same) == FRAMES + 3 and others == [[], []], f"the folder of {bag} is that of depth.bag: {others}")

    with open(f"{FOLDER}/laser.mcap", "rb") as whole, open(f"{FOLDER}/cut.mcap", "wb") as cut:
        cut.write(whole.read()[:600000])
    said = from_bag_here("cut.mcap", "--scan", "/scan", "--odom", "/odom", "-o", "cut.log")
    require("cut.mcap: was not closed" in said.stderr, said.stderr)
    with open(f"{FOLDER}/cut.log", encoding="ascii") as cut, open(f"{FOLDER}/plain.log", encoding="ascii") as whole:
        begin, log = cut.read(), whole.read()
        require(log.startswith(begin) and 100000 < len(begin) < len(log), "what was recorded until then is there")
    with open(f"{FOLDER}/no.db3", "w", encoding="ascii") as file:
        file.write("no bag\n")
    require_refusal("no.db3: file is not a database", "no.db3", "--scan", "/scan", "-o", "refused")
    require_refusal("holds no .db3 and no .mcap", "sequence", "--scan", "/scan", "-o", "refused")
    require_refusal("/odom is nav_msgs/Odometry, must be", "laser.mcap", "--scan", "/odom", "-o", "refused")


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    os.makedirs(FOLDER)
    os.chdir(FOLDER)
    sys.path.insert(0, os.path.dirname(FROM_BAG))  # as for a program that lies there
    for name, compression, upside_down, with_odometry in [
            ("plain", "none", False, True), ("turned_over", "lz4", True, True), ("tf_alone", "bz2", False, False)]:
        write_laser_bag(f"{FOLDER}/{name}.bag", compression, upside_down, with_odometry)
        odom = ["--odom", "/odom"] if with_odometry else []
        said = from_bag(f"{name}.bag", "--scan", "/scan", *odom, "-o", f"{name}.log")
        require(said.stdout.endswith(f"depthgrid map {name}.log -o map\n"), said.stdout)
        require("1 have no pose" in said.stderr, f"the first scan comes before the first pose: {said.stderr}")
        mapped = run(DEPTHGRID, "map", f"{name}.log", "-o", name)
        require("warning" not in mapped.stderr, f"{name}: {mapped.stderr}")
        error_m = mean_error_m(name, LASER, False)
        print(f"{name}: mean error {error_m:.4f} m")
        require(error_m < 0.03, f"{name}: {error_m} m, the odometry drifts by .3 m")
    listed = from_bag_here("plain.bag").stdout
    require("/scan  sensor_msgs/LaserScan  240\n" in listed, listed)

    write_depth_bag(f"{FOLDER}/depth.bag")
    said = from_bag("depth.bag", "--depth", "/camera/depth/image_raw", "--odom", "/odom", "-o", "sequence")
    command = said.stdout.split("next: ")[1].split()
    mapped = run(DEPTHGRID, *command[1:-1], "depth_map")
    error_m = mean_error_m("depth_map", (0.2, 0.0, 0.0), True)
    print(f"depth: mean error {error_m:.4f} m")
    require(error_m < 0.05, f"depth: {error_m} m")

    with open(f"{FOLDER}/no.bag", "w", encoding="ascii") as file:
        file.write("no bag\n")
    require_refusal("no.bag: ", "no.bag", "--scan", "/scan", "-o", "refused")
    with open(FOLDER + "/image.bag", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
    require_refusal("image.bag: is no ROS 1 bag", "image.bag")
    require_refusal("missing.bag: cannot be read: No such file", "missing.bag")
    require_refusal("missing.mcap: cannot be read: No such file", "missing.mcap")
    require_refusal("no topic /scann; of that kind are: /scan", "plain.bag", "--scan", "/scann", "-o", "refused")
    require_refusal("/odom is nav_msgs/Odometry, must be", "plain.bag", "--scan", "/odom", "-o", "refused")
    require_refusal("must be given", "plain.bag", "--scan", "/scan")
    require_refusal("plain.log: is there already", "plain.bag", "--scan", "/scan", "-o", "plain.log")
    require_refusal("joins no frame 'base_link' to 'odom'", "plain.bag", "--scan", "/scan", "-o", "refused")
    require_refusal("where 'laser' is on 'robot'", "plain.bag", "--scan", "/scan", "--odom", "/odom",
                    "--base-frame", "robot", "-o", "refused")
    require_refusal("no/such/refused: cannot be written: No such file", "plain.bag", "--scan", "/scan",
                    "--odom", "/odom", "-o", "no/such/refused")
    require_full_disk_is_told()
    require_far_depth_stays_far()
    require_same_of_ros2()
    os.chdir("/")
    shutil.rmtree(FOLDER)


main()
