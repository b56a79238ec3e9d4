#include "cli/slurm_queue.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>

#include "core/error.h"
#include "core/fingerprint.h"
#include "core/version.h"
#include "io/output.h"
#include "io/text_file.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostTasks = 1000;  // of an array: Slurm's own limit (MaxArraySize) is 1001 unless configured
constexpr int kTries = 3;
constexpr std::chrono::milliseconds kPoll = 2s, kNap = 100ms, kPatience = 600s;
constexpr std::size_t kLargestManifestMiB = 256;  // a million pieces are 8
constexpr const char* kScript = "#!/bin/sh\nexec \"$@\" \"$SLURM_ARRAY_TASK_ID\"\n";

struct Answer {
  bool good = false;
  std::string text;  // on both outputs
};

// Runs a program of Slurm's with these very arguments; no shell sees them. Its process group is its own, so that a
// Ctrl-C is ours alone to answer. What users set for their own look at the queue (SQUEUE_FORMAT ...) is kept from it.
Answer ask(const std::vector<std::string>& command) {
  std::vector<char*> arguments, environment;
  for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
  for (char** variable = environ; *variable; ++variable)
    if (!std::string_view(*variable).starts_with("SQUEUE_")) environment.push_back(*variable);
  arguments.push_back(nullptr);
  environment.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw WorkError(command[0], std::string("no pipe to it: ") + std::strerror(errno));
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
  posix_spawnattr_t apart;
  posix_spawnattr_init(&apart);
  posix_spawnattr_setflags(&apart, POSIX_SPAWN_SETPGROUP);
  pid_t child = 0;
  const int refused = posix_spawnp(&child, command[0].c_str(), &files, &apart, arguments.data(), environment.data());
  posix_spawnattr_destroy(&apart);
  posix_spawn_file_actions_destroy(&files);
  close(ends[1]);
  Answer answer;
  char part[4096];
  for (ssize_t n; (n = read(ends[0], part, sizeof part)) > 0 || (n < 0 && errno == EINTR);)
    if (n > 0) answer.text.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  if (refused != 0)
    throw WorkError("--engine slurm", command[0] + " cannot be run (" + std::strerror(refused) +
                                          "); install Slurm's client commands, or use --engine local");
  int status = -1;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  answer.good = status == 0;
  return answer;
}

[[noreturn]] void give_up(const Answer& answer) {
  throw WorkError("--engine slurm",
                  "Slurm says \"" + io::one_line(answer.text) + "\"; mend that, or use --engine local");
}

fs::path place_of(const fs::path& folder) { return fs::absolute(folder).lexically_normal(); }

// All jobs of a queue have one name, which a second start of the same command finds again.
std::string name_of(const fs::path& folder) {
  return fmt::format("tumble-{:016x}", fingerprint(place_of(folder).string()));
}

void cancel(const std::string& name) try {
  if (!ask({"scancel", "--me", "--name=" + name}).good)
    fmt::print(stderr, "tumble: jobs may be left in Slurm's queue; remove them with: scancel --me --name={}\n", name);
} catch (const WorkError&) {  // without Slurm there is no queue
}

nlohmann::json read_json(const fs::path& manifest) {
  return nlohmann::json::parse(io::read_text(manifest, "a manifest of tasks", kLargestManifestMiB));
}

// The tasks' common log ends with what went wrong last.
std::string last_words(const fs::path& log) {
  constexpr std::streamoff kTail = 2000;
  std::ifstream file(log, std::ios::binary | std::ios::ate);
  file.seekg(std::max<std::streamoff>(0, file.tellg() - kTail));
  std::string last = "nothing";
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return io::one_line(last);
}

class Queue {
 public:
  Queue(const SlurmWork& work, const Progress& progress)
      : work_(work), progress_(progress), folder_(place_of(work.folder)), name_(name_of(work.folder)) {}

  bool busy();  // are there tasks that wait or run? Yes, as long as Slurm may be expected to answer again
  void submit(const std::vector<std::size_t>& pieces, std::size_t per_task);
  void wait(std::size_t left) const;
  void run();

 private:
  Answer jobs() const { return ask({"squeue", "--me", "--noheader", "--name=" + name_, "--format=%j"}); }
  fs::path manifest(std::size_t round) const { return folder_ / fmt::format("{}.json", round); }
  std::size_t rounds() const {  // that were submitted, by earlier starts too
    std::size_t n = 0;
    while (fs::exists(manifest(n + 1))) ++n;
    return n;
  }

  const SlurmWork& work_;
  const Progress& progress_;
  fs::path folder_;
  std::string name_;
  std::optional<Clock::time_point> heard_;  // of Slurm, last
};

bool Queue::busy() {
  const Answer answer = jobs();
  if (answer.good) {
    heard_ = Clock::now();
    return answer.text.find(name_) != std::string::npos;
  }
  if (!heard_ || Clock::now() - *heard_ > kPatience) give_up(answer);
  return true;
}

void Queue::submit(const std::vector<std::size_t>& pieces, std::size_t per_task) {
  const auto in = [&](std::size_t portions) { return (pieces.size() + portions - 1) / portions; };
  per_task = std::max(per_task, in(kMostTasks));
  const fs::path asked = manifest(rounds() + 1), script = folder_ / "task.sh";
  io::make_output_folder(folder_);
  io::write_text(script, kScript);
  io::write_text(
      asked,
      nlohmann::json{
          {"tumble", kVersion}, {"kind", work_.kind}, {"plan", work_.plan}, {"per_task", per_task}, {"pieces", pieces}}
          .dump());
  // Not to be queued anew by Slurm: the rounds see to that, and a job's number then stands for one process. The log's
  // name has no folder: Slurm would take a % in it for its own.
  const std::vector<std::string> command{"sbatch",
                                         "--job-name=" + name_,
                                         fmt::format("--array=0-{}", in(per_task)-1),
                                         "--ntasks=1",
                                         fmt::format("--cpus-per-task={}", work_.threads),
                                         "--no-requeue",
                                         "--open-mode=append",
                                         "--chdir=" + folder_.string(),
                                         "--output=log",
                                         script.string(),
                                         (fs::read_symlink("/proc/self/exe").parent_path() / "tumble").string(),
                                         "task",
                                         asked.string()};
  for (int refused = 0;;) {
    const Answer answer = ask(command);
    if (answer.good) return;
    if (jobs().good && ++refused == 2) give_up(answer);  // it was not that nobody answered
    busy();
    wait(pieces.size());
  }
}

void Queue::wait(std::size_t left) const {
  for (const auto end = Clock::now() + kPoll; Clock::now() < end; std::this_thread::sleep_for(kNap))
    report(progress_, double(work_.pieces - left) / double(work_.pieces));
}

void Queue::run() {
  std::vector<std::size_t> left = work_.left();
  if (const std::size_t n = rounds(); n > 0 && read_json(manifest(n)).value("plan", nlohmann::json()) != work_.plan)
    discard_slurm_queue(folder_);  // of other work; what of it serves this is known by now
  int vain = 0;                    // rounds in a row that brought nothing
  for (bool waiting = busy(); !left.empty(); waiting = false) {
    const std::size_t before = left.size();
    if (!waiting)
      submit(left, vain == 0 ? work_.per_task : 1);  // a piece that kills its task is not to take others along
    do {
      wait(left.size());
      left = work_.left();
    } while (!left.empty() && busy());
    left = work_.left();  // what was written between the two questions
    vain = left.size() < before ? 0 : vain + 1;
    if (vain == kTries)
      throw WorkError(folder_.string(),
                      fmt::format("{} of {} pieces of work have no result, and {} rounds of tasks brought none; the "
                                  "last line of log there: {}",
                                  left.size(), work_.pieces, kTries, last_words(folder_ / "log")));
  }
}

}  // namespace

void check_slurm() {
  if (const Answer answer = ask({"squeue", "--me", "--noheader"}); !answer.good) give_up(answer);
}

void do_by_slurm(const SlurmWork& work, const Progress& progress) {
  try {
    Queue(work, progress).run();
  } catch (...) {
    cancel(name_of(work.folder));
    throw;
  }
  discard_slurm_queue(work.folder);
}

void discard_slurm_queue(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  cancel(name_of(folder));
  fs::remove_all(folder, error);
}

SlurmTask read_slurm_task(const fs::path& manifest, std::size_t number) {
  const nlohmann::json m = read_json(manifest);
  if (m.at("tumble") != kVersion)
    throw WorkError(manifest.string(),
                    "was written by tumble " + m.at("tumble").get<std::string>() + ", this is " + kVersion);
  const auto& pieces = m.at("pieces");
  const auto per_task = m.at("per_task").get<std::size_t>();
  SlurmTask task{m.at("kind"), m.at("plan"), {}, manifest};
  for (std::size_t i = number * per_task; i < std::min((number + 1) * per_task, pieces.size()); ++i)
    task.pieces.push_back(pieces[i]);
  const char* const job = std::getenv("SLURM_JOB_ID");
  task.own.replace_extension(fmt::format("task-{}-{}", number, job ? job : "0"));
  return task;
}

}  // namespace tumble::cli
