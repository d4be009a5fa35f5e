// A headless Chromium for tests of the report pages, driven over a pair of pipes with its DevTools
// protocol (messages are JSON, each ended by a zero byte). Nothing listens on a port.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace depthgrid {

// The program's path, if there is one.
inline std::optional<std::string> FindChromium() {
  const char* search = std::getenv("PATH");
  std::istringstream folders(search != nullptr ? search : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
      const std::string path = folder + "/" + name;
      if (access(path.c_str(), X_OK) == 0) return path;
    }
  }
  return std::nullopt;
}

class Browser {
 public:
  using Json = nlohmann::json;

  // `folder`, which must not exist yet, takes the browser's profile.
  Browser(const std::string& program, const std::string& folder) : folder_(folder) {
    std::array<int, 2> in{};
    std::array<int, 2> out{};
    if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) {
      throw std::runtime_error("no pipe");
    }
    std::filesystem::create_directories(folder);
    prctl(PR_SET_CHILD_SUBREAPER, 1);  // its helpers outlive it and are waited for here
    child_ = fork();
    if (child_ == 0) Become(program, in[0], out[1]);
    close(in[0]);
    close(out[1]);
    to_ = in[1];
    from_ = out[0];
    const Json page = Call("Target.createTarget", {{"url", "about:blank"}});
    const Json attached =
        Call("Target.attachToTarget", {{"targetId", page["targetId"]}, {"flatten", true}});
    session_ = attached["sessionId"];
    for (const char* domain : {"Page", "Runtime", "Log", "Network"}) {
      Call(std::string(domain) + ".enable");
    }
  }
  ~Browser() {
    kill(-child_, SIGKILL);  // its own group: the browser and all its helpers
    while (waitpid(-child_, nullptr, 0) > 0) {
    }
    close(to_);
    close(from_);
    std::error_code still_busy;
    std::filesystem::remove_all(folder_, still_busy);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  // Returns when the page's own flag says that its scripts ran to the end.
  void Open(const std::string& file, int width_px = 1280) {
    Call("Emulation.setDeviceMetricsOverride",
         {{"width", width_px}, {"height", 900}, {"deviceScaleFactor", 1}, {"mobile", false}});
    problems_.clear();
    Call("Page.navigate", {{"url", "file://" + file}});
    WaitFor("document.documentElement?.dataset.ready === 'true'");
  }
  Json Evaluate(const std::string& script) {
    const Json answer = Call("Runtime.evaluate", {{"expression", script}, {"returnByValue", true}});
    if (answer.contains("exceptionDetails")) {
      throw std::runtime_error(script + ": " + answer["exceptionDetails"].dump());
    }
    return answer["result"].value("value", Json());
  }
  void WaitFor(const std::string& condition) {
    const auto give_up = Clock::now() + kPatience;
    while (Evaluate(condition) != true) {
      if (Clock::now() > give_up) {
        throw std::runtime_error("never true: " + condition + "; " + Json(problems_).dump());
      }
      usleep(20'000);
    }
  }
  // A real click in the middle of the element, after scrolling to it.
  void Click(const std::string& selector) {
    const Json middle = Evaluate(
        "(() => { const e = document.querySelector('" + selector +
        "'); e.scrollIntoView({block: 'center'}); const r = e.getBoundingClientRect(); return [r.x "
        "+ r.width / 2, r.y + r.height / 2]; })()");
    for (const char* type : {"mousePressed", "mouseReleased"}) {
      Call("Input.dispatchMouseEvent", {{"type", type},
                                        {"x", middle[0]},
                                        {"y", middle[1]},
                                        {"button", "left"},
                                        {"clickCount", 1}});
    }
  }
  // `key` as in KeyboardEvent.key; a single character also types it.
  void Press(const std::string& key, int virtual_key_code = 0) {
    Json event = {{"type", "keyDown"}, {"key", key}};
    if (key.size() == 1) event["text"] = key;
    if (virtual_key_code != 0) event["windowsVirtualKeyCode"] = virtual_key_code;
    Call("Input.dispatchKeyEvent", event);
    event["type"] = "keyUp";
    event.erase("text");
    Call("Input.dispatchKeyEvent", event);
  }
  // Script errors, error messages of the console, and requests to anything but files, since Open.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPatience{30};  // of a loaded machine

  [[noreturn]] void Become(const std::string& program, int in, int out) const {
    setpgid(0, 0);
    // The protocol uses fixed descriptors. These are copied out of the way first, because they may
    // have the same numbers.
    const int in_copy = fcntl(in, F_DUPFD, 10);
    const int out_copy = fcntl(out, F_DUPFD, 10);
    dup2(in_copy, 3);
    dup2(out_copy, 4);
    const int nothing = open("/dev/null", O_RDWR);
    for (const int stream : {0, 1, 2}) dup2(nothing, stream);
    // When killed it leaves temporary files and settings outside the profile; in this folder they
    // are removed with it. Relative paths, because its socket's path must fit into 107 bytes.
    if (chdir(folder_.c_str()) != 0) _exit(127);
    setenv("TMPDIR", ".", 1);
    setenv("HOME", folder_.c_str(), 1);
    const std::string profile = "--user-data-dir=" + folder_;
    // --no-sandbox: tests run as root in containers, and open files of their own only.
    execl(program.c_str(), program.c_str(), "--headless", "--no-sandbox", "--disable-gpu",
          "--disable-dev-shm-usage", "--disable-quic", "--no-first-run", "--disable-sync",
          "--disable-background-networking", "--disable-component-update", "--disable-extensions",
          profile.c_str(), "--remote-debugging-pipe", "about:blank", nullptr);
    _exit(127);
  }

  Json Call(const std::string& method, const Json& parameters = Json::object()) {
    const int id = ++last_id_;
    Json message = {{"id", id}, {"method", method}, {"params", parameters}};
    if (!session_.empty()) message["sessionId"] = session_;
    const std::string text = message.dump() + '\0';
    for (std::size_t sent = 0; sent < text.size();) {
      const ssize_t wrote = write(to_, text.data() + sent, text.size() - sent);
      if (wrote <= 0) throw std::runtime_error("the browser is gone");
      sent += static_cast<std::size_t>(wrote);
    }
    while (true) {
      const Json answer = Receive(method);
      if (answer.value("id", 0) == id) {
        if (answer.contains("error")) throw std::runtime_error(method + answer["error"].dump());
        return answer["result"];
      }
      Note(answer);
    }
  }
  Json Receive(const std::string& method) {
    const auto give_up = Clock::now() + kPatience;
    while (true) {
      if (const std::size_t end = received_.find('\0'); end != std::string::npos) {
        const Json message = Json::parse(received_.substr(0, end));
        received_.erase(0, end + 1);
        return message;
      }
      pollfd ready{.fd = from_, .events = POLLIN, .revents = 0};
      std::array<char, 65536> part{};
      if (poll(&ready, 1, 1000) > 0) {
        const ssize_t got = read(from_, part.data(), part.size());
        if (got <= 0) throw std::runtime_error("the browser is gone");
        received_.append(part.data(), static_cast<std::size_t>(got));
      }
      if (Clock::now() > give_up) throw std::runtime_error("no answer to " + method);
    }
  }
  void Note(const Json& event) {
    const std::string method = event.value("method", "");
    if (method == "Runtime.exceptionThrown") problems_.push_back(event["params"].dump());
    if (method == "Log.entryAdded" && event["params"]["entry"]["level"] == "error") {
      problems_.push_back(event["params"].dump());
    }
    if (method == "Network.requestWillBeSent") {
      const std::string url = event["params"]["request"]["url"];
      if (!url.starts_with("file:") && !url.starts_with("data:")) problems_.push_back(url);
    }
  }

  std::string folder_;
  pid_t child_ = -1;
  int to_ = -1;
  int from_ = -1;
  int last_id_ = 0;
  std::string session_;
  std::string received_;
  std::vector<std::string> problems_;
};

}  // namespace depthgrid
