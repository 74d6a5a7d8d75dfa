#include "meshing/gmsh_contents.hpp"

#include <nlohmann/json.hpp>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>

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

GmshContents call_module(const std::filesystem::path& path) {
  const std::filesystem::path name = "dielast_gmsh.so";
  std::error_code ignored;
  const auto beside_program = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
  void* module = dlopen(beside_program.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) module = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = module ? dlsym(module, gmsh_module_function) : nullptr;
  if (!function)
    return failure(std::string("mesh files need the gmsh module, which cannot be loaded: ") + dlerror());
  GmshContents contents;
  reinterpret_cast<GmshModuleFunction*>(function)(path.c_str(), &contents);
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

[[noreturn]] void run_child(const std::filesystem::path& path, int output) {
  // gmsh and a dying C library talk to the terminal.
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  bool complete = false;
  try {
    complete = write_all(output, nlohmann::json::to_cbor(nlohmann::json(call_module(path))));
  } catch (...) { // reported by the exit code
  }
  _exit(complete ? 0 : 1);
}

} // namespace

GmshContents read_gmsh_contents(const std::filesystem::path& path) {
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) return failure("no pipe to gmsh can be opened");
  const pid_t child = fork();
  if (child == 0) run_child(path, pipe_ends[1]);
  close(pipe_ends[1]);
  const std::vector<std::uint8_t> bytes = read_all(pipe_ends[0]);
  close(pipe_ends[0]);
  if (child < 0) return failure("no process for gmsh can be started");

  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return failure("gmsh crashes on this mesh file; it is damaged, write it again");
  return nlohmann::json::from_cbor(bytes).get<GmshContents>();
}

} // namespace dielast::meshing
