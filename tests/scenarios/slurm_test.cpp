#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

/// `campaign --engine slurm` on a real Slurm of two nodes, both on this machine, started here for the test.
namespace understory::support {
namespace {

namespace fs = std::filesystem;

bool installed() {
  for (const char* program : {"slurmctld", "slurmd", "sbatch", "squeue", "munged"})
    if (std::system(("command -v " + std::string(program) + " >/dev/null 2>&1").c_str()) != 0) return false;
  return true;
}

/// munged, slurmctld and two slurmd with keys, ports and folders of their own.
class Cluster {
 public:
  explicit Cluster(const fs::path& folder) : folder_(folder) {
    for (const char* part : {"munge", "state", "spool-n1", "spool-n2"}) fs::create_directories(folder / part);
    fs::permissions(folder / "munge", fs::perms::owner_all);
    run("dd if=/dev/urandom of=munge/key bs=128 count=1 2>/dev/null && chmod 400 munge/key");
    run("munged --force --key-file=$PWD/munge/key --socket=$PWD/munge/socket --pid-file=$PWD/munge/pid "
        "--log-file=$PWD/munge/log --seed-file=$PWD/munge/seed");
    std::ofstream(folder / "slurm.conf") << configuration();
    setenv("SLURM_CONF", (folder / "slurm.conf").c_str(), 1);
    run("slurmctld -i");
    for (const char* node : {"n1", "n2"}) run("slurmd -N " + std::string(node));
  }
  ~Cluster() {
    for (const char* node : {"n1", "n2"}) kill_node(node);
    // Gone before their folder is: the controller writes its state until the end.
    run("for pid in $(cat slurmctld.pid) $(cat munge/pid); do"
        " kill $pid; for turn in $(seq 100); do kill -0 $pid || break; sleep 0.1; done; done 2>/dev/null");
    unsetenv("SLURM_CONF");
  }
  Cluster(const Cluster&) = delete;
  Cluster& operator=(const Cluster&) = delete;

  bool is_idle() const {
    for (int attempt = 0; attempt < 100; ++attempt) {
      if (std::system("sinfo --noheader --format=%T 2>/dev/null | grep -qx idle") == 0) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    return false;
  }

  /// As a power cut does it: the daemon, its steps and all that they started, at once; a step that saw its
  /// task die first would still report it.
  void kill_node(const std::string& node) const {
    std::set<pid_t> processes;
    for (const auto& process : fs::directory_iterator("/proc")) {
      const std::string name = process.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      const std::string variables = content_of(process.path() / "environ");
      if (variables.find(folder_.string()) == std::string::npos) continue;  // another cluster's, or none's
      std::string arguments = content_of(process.path() / "cmdline");
      std::erase(arguments, '\0');
      const bool is_daemon = arguments.find("slurmd-N" + node) != std::string::npos;
      const bool is_task = variables.find("SLURMD_NODENAME=" + node) != std::string::npos;
      if (is_daemon || is_task) processes.insert(std::stoi(name));
      if (is_task) processes.insert(parent_of(process.path()));  // the step, or a task again
    }
    for (const pid_t none_of_ours : {-1, 0, 1}) processes.erase(none_of_ours);
    processes.erase(getpid());
    for (const pid_t process : processes) kill(process, SIGSTOP);
    for (const pid_t process : processes) kill(process, SIGKILL);
  }

 private:
  static pid_t parent_of(const fs::path& process) {
    std::ifstream stream(process / "status");
    for (std::string line; std::getline(stream, line);)
      if (line.starts_with("PPid:")) return std::stoi(line.substr(5));
    return 1;
  }

  void run(const std::string& command) const {
    EXPECT_EQ(std::system(("cd '" + folder_.string() + "' && " + command).c_str()), 0) << command;
  }

  std::string configuration() const {
    const int port = 20000 + getpid() % 20000;
    const char* user = geteuid() == 0 ? "root" : std::getenv("USER");
    // A requeued job waits for its old credential to expire: two minutes, were it not said.
    return fmt::format(R"(ClusterName=understory
SlurmctldHost=localhost
AuthType=auth/munge
AuthInfo=socket={0}/munge/socket,cred_expire=5
SlurmUser={1}
SlurmdUser={1}
StateSaveLocation={0}/state
SlurmdSpoolDir={0}/spool-%n
SlurmctldPidFile={0}/slurmctld.pid
SlurmdPidFile={0}/slurmd-%n.pid
SlurmctldLogFile={0}/slurmctld.log
SlurmdLogFile={0}/slurmd-%n.log
SlurmctldPort={2}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0
SlurmdParameters=config_overrides
SlurmdTimeout=5
SlurmctldTimeout=10
KillWait=2
ReturnToService=2
JobRequeue=1
MinJobAge=300
NodeName=n1 NodeHostname=localhost NodeAddr=127.0.0.1 Port={3} CPUs=1 State=UNKNOWN
NodeName=n2 NodeHostname=localhost NodeAddr=127.0.0.1 Port={4} CPUs=1 State=UNKNOWN
PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
)",
                       folder_.string(), user, port, port + 1, port + 2);
  }

  fs::path folder_;
};

/// Flights that are over.
long count_flights(const fs::path& results) {
  std::error_code ignored;
  long count = 0;
  for (const auto& entry : fs::directory_iterator(results / "flights", ignored))
    count += entry.path().extension() == ".json" ? 1 : 0;
  return count;
}

TEST(Slurm, ACampaignOutlivesOneOfItsNodes) {
  if (!installed()) GTEST_SKIP() << "Slurm is not installed (Debian: slurm-wlm, munge)";
  const understory::support::TemporaryFolder folder;
  const std::string campaign = (folder.path() / "blind.yaml").string();
  std::ofstream(campaign)
      << "scenario: clear\nseeds: 1..60\noverrides: [{name: blind, set: {perception.detector: none}}]\n";
  const fs::path here = folder.path() / "here", there = folder.path() / "there";
  expect_success("campaign " + campaign + " --out " + here.string());

  const Cluster cluster(folder.path() / "cluster");
  ASSERT_TRUE(cluster.is_idle());
  expect_success("campaign " + campaign + " --out " + there.string() +
                 " --engine slurm --shards 4 --no-wait");
  for (; count_flights(there) < 10;) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  cluster.kill_node("n2");
  for (; count_flights(there) < 60;) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  expect_success("collect " + there.string());
  EXPECT_EQ(content_of(there / "flights.csv"), content_of(here / "flights.csv"));
}

TEST(Slurm, WithoutItOneLineSaysSo) {
  const understory::support::TemporaryFolder folder;
  const std::string campaign = folder.write("blind.yaml", "scenario: clear\nseeds: 1\n").string();
  understory::support::expect_refusal(
      "campaign " + campaign + " --out " + (folder.path() / "results").string() + " --engine slurm",
      "--engine slurm: sbatch is missing", 3, "PATH=/proc/nowhere");
}

}  // namespace
}  // namespace understory::support
