// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/gmsh/gmsh_contents.hpp"

#include <nlohmann/json.hpp>

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>

namespace dielast::meshing {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GmshContents::Elements, dimension, entity, type, nodes_each, nodes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GmshContents::PhysicalGroup, dimension, tag, name, entities)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(GmshContents, error, node_tags, coordinates, elements, groups)

namespace {

GmshContents failure(std::string message) {
  GmshContents contents;
  contents.error = std::move(message);
  return contents;
}

/// Takes away the right to start programs and to change files: gmsh can do both, and its window system
/// leaves settings in the user's home, /etc and wherever else it may. A kernel without filters reads on.
void only_read() {
  constexpr auto forbid = [](std::uint32_t call) {
    return std::array<sock_filter, 2>{{BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, call, 0, 1),
                                       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM)}};
  };
  std::vector<sock_filter> filter{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const std::uint32_t call : {
#ifdef SYS_open // older systems; others call openat for all of these
           SYS_open, SYS_creat, SYS_mkdir, SYS_rename, SYS_unlink,
#endif
           SYS_execve, SYS_execveat, SYS_mkdirat, SYS_renameat2, SYS_unlinkat, SYS_truncate, SYS_socket})
    for (const sock_filter& line : forbid(call)) filter.push_back(line);
  constexpr std::uint32_t writing = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
  const std::array<sock_filter, 5> end{
      {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
       BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args) + 2 * sizeof(std::uint64_t)),
       BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, writing, 0, 1),
       BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  filter.insert(filter.end(), end.begin(), end.end());
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

GmshContents call_module(const std::string& path) {
  const std::filesystem::path name = "dielast_gmsh.so";
  std::error_code ignored;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  void* module = nullptr; // beside the program as it is built, in a folder of libraries where it is installed
  for (const auto& folder : {program, program / DIELAST_MODULE_FOLDER})
    if (!module) module = dlopen((folder / name).c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = module ? dlsym(module, gmsh_module_function) : nullptr;
  if (!function)
    return failure(std::string("mesh files need the gmsh module, which cannot be loaded: ") + dlerror());
  GmshContents contents;
  reinterpret_cast<GmshModuleFunction*>(function)(path.c_str(), &contents);
  if (const auto named = contents.error.find("'" + path + "'"); named != std::string::npos)
    contents.error.replace(named, path.size() + 2, "it");
  return contents;
}

/// Writes everything; false when the reader has gone.
bool write_all(int file, const std::vector<std::uint8_t>& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written = write(file, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) done += static_cast<std::size_t>(written);
  }
  return true;
}

std::vector<std::uint8_t> read_all(int file) {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 65536> chunk;
  for (;;) {
    const ssize_t count = read(file, chunk.data(), chunk.size());
    if (count == 0 || (count < 0 && errno != EINTR)) return bytes;
    if (count > 0) bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + count);
  }
}

/// Whether a file begins as the meshes that gmsh writes do. gmsh itself takes every other text for a script
/// and runs its commands.
bool has_mesh_head(int file) {
  std::array<char, 64> bytes{};
  const ssize_t count = pread(file, bytes.data(), bytes.size(), 0);
  std::string_view head(bytes.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  const auto skip = [&](std::string_view text) {
    const bool found = head.starts_with(text);
    if (found) head.remove_prefix(text.size());
    return found;
  };
  if (!skip("$MeshFormat")) return false;
  skip("\r");
  return skip("\n") && (skip("4.1 ") || skip("2.2 "));
}

/// Descriptor of a copy in memory that nobody else has, and that has no neighbours: beside a mesh gmsh looks
/// for commands in a file of its name with ".opt" at the end. -1, and errno, when there is none.
int private_copy(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  const int copy = memfd_create("mesh", MFD_CLOEXEC);
  struct stat status {};
  bool complete = file >= 0 && copy >= 0 && fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  std::vector<std::uint8_t> chunk(1 << 20);
  for (ssize_t count = 1; complete && count != 0;) {
    count = read(file, chunk.data(), chunk.size());
    if (count < 0 && errno == EINTR) continue;
    chunk.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    complete = count >= 0 && write_all(copy, chunk);
    chunk.resize(1 << 20);
  }
  const int reason = errno;
  close(file);
  if (complete) return copy;
  close(copy);
  errno = reason;
  return -1;
}

/// gmsh believes the counts of a damaged file: whole files take less than a second and 20 bytes per byte.
void bound(const std::string& path) {
  struct stat status {};
  stat(path.c_str(), &status);
  const auto megabytes = static_cast<rlim_t>(status.st_size >> 20);
  const auto limit = [](auto resource, rlim_t most) {
    const rlimit both{most, most};
    setrlimit(resource, &both);
  };
  const rlim_t most_time = 10 + megabytes; // s
  constexpr rlim_t busy = 10;              // on a machine with other work
  limit(RLIMIT_CPU, most_time);
  alarm(static_cast<unsigned>(busy * most_time)); // a process that waits for itself takes no CPU time
  std::ifstream sizes("/proc/self/statm");
  rlim_t pages = 0; // of data, so far: the sixth of the numbers
  for (int i = 0; i < 6; ++i) sizes >> pages;
  if (sizes)
    limit(RLIMIT_DATA, pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + ((1024 + 100 * megabytes) << 20));
}

[[noreturn]] void run_child(const std::string& path, int output) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGALRM}) std::signal(signal, SIG_DFL);
  setenv("HOME", "/dev/null", 1); // nor are settings read from there
  bound(path);
  // gmsh and a dying C library talk to the terminal.
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  only_read();
  bool complete = false;
  try {
    complete = write_all(output, nlohmann::json::to_cbor(nlohmann::json(call_module(path))));
  } catch (...) { // reported by the exit code
  }
  _exit(complete ? 0 : 1);
}

} // namespace

GmshContents read_gmsh_contents(const std::filesystem::path& path) {
  const int copy = private_copy(path);
  if (copy < 0) return failure(std::string("it cannot be read: ") + std::strerror(errno));
  const std::string name = "/proc/self/fd/" + std::to_string(copy);
  std::array<int, 2> pipe_ends{};
  const bool mesh = has_mesh_head(copy), piped = mesh && pipe2(pipe_ends.data(), O_CLOEXEC) == 0;
  const pid_t child = piped ? fork() : -1;
  if (child == 0) run_child(name, pipe_ends[1]);
  close(copy);
  if (!mesh)
    return failure("it does not begin with $MeshFormat and the version 4.1 or 2.2; write it with: gmsh -2 "
                   "-format msh41");
  if (!piped) return failure("no pipe to gmsh can be opened");
  close(pipe_ends[1]);
  const std::vector<std::uint8_t> bytes = read_all(pipe_ends[0]);
  close(pipe_ends[0]);
  if (child < 0) return failure("no process for gmsh can be started");

  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr std::array bounds{SIGKILL, SIGXCPU, SIGALRM};
  if (WIFSIGNALED(status) && std::ranges::count(bounds, WTERMSIG(status)))
    return failure("gmsh comes to no end with this mesh file; it is damaged, write it again");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return failure("gmsh crashes on this mesh file; it is damaged, write it again");
  return nlohmann::json::from_cbor(bytes).get<GmshContents>();
}

} // namespace dielast::meshing
