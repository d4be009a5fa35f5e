#include "eval/pictures/video_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>
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
  // The prefix protects names that begin with "-" or look like a protocol.
  command.push_back("file:" + path);
  return command;
}

// Starts ffmpeg, which reads from a socket: if ffmpeg has ended, writing to a socket can fail
// without a signal, whereas for a pipe the whole program would have to ignore SIGPIPE. ffmpeg's
// messages go to the file `errors`.
int Start(const std::vector<std::string>& command, int errors, int& pipe_end) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::runtime_error("ffmpeg: no pipe");
  }
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  if (errors >= 0) posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
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

// Whether the boxes (ISO/IEC 14496-12, 4.2) fill the file and include the index of frames. ffmpeg
// ends with exit code 0 even if the disk is full when it writes the index.
bool IsWholeMp4(const std::string& path) {
  std::error_code error;
  const std::uint64_t end = fs::file_size(path, error);
  if (error) return false;
  std::ifstream file(path, std::ios::binary);
  const auto number = [&file](int bytes) {  // big-endian
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8U | static_cast<unsigned char>(file.get());
    return value;
  };
  bool has_index = false;
  for (std::uint64_t at = 0; at < end;) {
    file.seekg(static_cast<std::streamoff>(at));
    std::uint64_t size = number(4);
    std::array<char, 4> kind{};
    file.read(kind.data(), kind.size());
    constexpr std::uint64_t kLong = 1;  // the size follows, in 8 bytes
    if (size == kLong) size = number(8);
    constexpr std::uint64_t kLeastBox = 8;
    if (!file || size < kLeastBox || size > end - at) return false;
    has_index = has_index || std::string_view(kind.data(), kind.size()) == "moov";
    at += size;
  }
  return has_index;
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
  errors_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
  process_ = Start(CommandFor(temporary_, width_px, height_px, frames_per_s), errors_, pipe_);
}

VideoWriter::~VideoWriter() {
  Abandon();
  Close();
  if (errors_ >= 0) ::close(errors_);
}

// Ends ffmpeg, so that it neither continues nor complains of a removed file.
void VideoWriter::Abandon() {
  const int process = process_;
  if (process > 0) ::kill(process, SIGKILL);
}

void VideoWriter::Add(const RgbImage& frame) {
  Require(frame.width_px == width_px_ && frame.height_px == height_px_,
          "all frames of a video have one size");
  std::size_t done = 0;
  while (done < frame.rgb.size()) {
    const auto written =
        ::send(pipe_, frame.rgb.data() + done, frame.rgb.size() - done, MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      Close();
      throw std::runtime_error(path_ + ": ffmpeg ended before the video did" + Complaint());
    }
    done += static_cast<std::size_t>(written);
  }
}

void VideoWriter::Close() {
  if (pipe_ >= 0) ::close(pipe_);
  pipe_ = -1;
  while (process_ > 0 && ::waitpid(process_, &status_, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
}

// ffmpeg's first message, in brackets; empty if there is none.
std::string VideoWriter::Complaint() const {
  std::array<char, 400> text{};
  const auto size = errors_ < 0 ? 0 : ::pread(errors_, text.data(), text.size(), 0);
  const std::string_view said(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  const std::string_view line = said.substr(0, said.find('\n'));
  return line.empty() ? "" : fmt::format(" ({})", line);
}

void VideoWriter::Finish() {
  Close();
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) {
    throw std::runtime_error(path_ + ": ffmpeg failed" + Complaint());
  }
  if (!IsWholeMp4(temporary_)) {
    throw std::runtime_error(path_ + ": cannot be written by ffmpeg" + Complaint());
  }
  fs::rename(temporary_, path_);
}

}  // namespace depthgrid
