#include "eval/video_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "mapper/core/error.h"

namespace depthgrid {
namespace {

namespace fs = std::filesystem;

// x264's constant quality: a map's sharp edges stay sharp, 30 s of it are about 1 MB.
constexpr int kQuality = 20;

bool HasProgram(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  }
  return false;
}

// One thread and "bitexact": no version, date or thread count in the bytes. H.264 with 4:2:0 needs
// even sizes.
std::vector<std::string> CommandFor(const std::string& path, int width_px, int height_px,
                                    int frames_per_s) {
  std::istringstream words(fmt::format(
      "ffmpeg -nostdin -loglevel error -y -f rawvideo -pix_fmt rgb24 -s {}x{} -r {} -i pipe:0 -an "
      "-vf pad=ceil(iw/2)*2:ceil(ih/2)*2 -c:v libx264 -preset medium -crf {} -pix_fmt yuv420p "
      "-threads 1 -fflags +bitexact -flags:v +bitexact -movflags +faststart -f mp4",
      width_px, height_px, frames_per_s, kQuality));
  std::vector<std::string> command(std::istream_iterator<std::string>(words), {});
  // Whatever it begins with: "-", or what ffmpeg takes for a protocol.
  command.push_back("file:" + path);
  return command;
}

// Starts ffmpeg reading from a pipe; its other end.
int Start(const std::vector<std::string>& command, int& pipe_end) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("ffmpeg: no pipe");
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  pid_t process = -1;
  const int error =
      ::posix_spawnp(&process, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[0]);
  if (error != 0) {
    ::close(ends[1]);
    throw std::runtime_error("ffmpeg cannot be started");
  }
  pipe_end = ends[1];
  return process;
}

}  // namespace

void RequireVideo(const std::string& path) {
  if (!path.ends_with(".mp4")) throw InputError(path, "must end in .mp4");
  if (!HasProgram("ffmpeg")) {
    throw InputError("--video", "needs the program ffmpeg (Debian: apt install ffmpeg)");
  }
}

VideoWriter::VideoWriter(std::string path, int width_px, int height_px, int frames_per_s)
    : path_(std::move(path)),
      temporary_(fmt::format("{}.{}.tmp", path_, ::getpid())),
      width_px_(width_px),
      height_px_(height_px),
      remove_temporary_([this] {
        Abandon();
        std::error_code ignored;
        fs::remove(temporary_, ignored);
      }) {
  process_ = Start(CommandFor(temporary_, width_px, height_px, frames_per_s), pipe_);
  // A dead ffmpeg is told by write() and its exit code, not by a signal.
  std::signal(SIGPIPE, SIG_IGN);
}

VideoWriter::~VideoWriter() {
  Abandon();
  Close();
}

// So that it neither goes on without us nor complains of a file that is gone.
void VideoWriter::Abandon() {
  const int process = process_;
  if (process > 0) ::kill(process, SIGKILL);
}

void VideoWriter::Add(const RgbImage& frame) {
  Require(frame.width_px == width_px_ && frame.height_px == height_px_,
          "all frames of a video have one size");
  std::size_t done = 0;
  while (done < frame.rgb.size()) {
    const auto written = ::write(pipe_, frame.rgb.data() + done, frame.rgb.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::runtime_error(path_ + ": ffmpeg ended before the video did");
    done += static_cast<std::size_t>(written);
  }
}

void VideoWriter::Close() {
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  while (process_ > 0 && ::waitpid(process_, &status_, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
}

void VideoWriter::Finish() {
  Close();
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) {
    throw std::runtime_error(path_ + ": ffmpeg failed");
  }
  fs::rename(temporary_, path_);
}

}  // namespace depthgrid
