#include "io/output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

fs::path parent_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

void check_writable(const fs::path& folder, const fs::path& output) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError(output.string(), "its folder " + folder.string() + " does not exist; make it first");
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(output.string(), "its folder " + folder.string() + " cannot be written to (" +
                                          std::strerror(errno) + "); choose another");
}

}  // namespace

void check_output_file(const fs::path& path, bool force) {
  std::error_code error;
  if (path.empty()) throw InputError("output", "has an empty name; give a file");
  if (!path.has_filename()) throw InputError(path.string(), "names a folder; give a file");
  if (fs::is_directory(path, error)) throw InputError(path.string(), "is a folder; give a file");
  // Outputs are renamed into place: even with `force` that must not put a file where /dev/null was.
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw InputError(path.string(), "is a device or a pipe; give a file");
  check_writable(parent_of(path), path);
  if (fs::exists(fs::symlink_status(path, error)) && !force)
    throw InputError(path.string(), "exists; remove it or add --force to replace it");
}

void check_not_input(const fs::path& output, const fs::path& input) {
  std::error_code error;
  if (fs::equivalent(output, input, error) && !error)
    throw InputError(output.string(), "is the input itself; give another output");
}

void check_apart(const std::vector<fs::path>& outputs) {
  const auto place_of = [](const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(fs::absolute(path), error);
    return error ? path.lexically_normal() : whole;
  };
  for (std::size_t i = 0; i < outputs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!outputs[i].empty() && !outputs[j].empty() && place_of(outputs[i]) == place_of(outputs[j]))
        throw InputError(outputs[i].string(), "is named for two outputs; give each a name of its own");
}

void make_output_folder(const fs::path& path) {
  std::error_code error;
  if (path.empty()) throw InputError("output", "has an empty name; give a folder");
  const fs::path folder = path.has_filename() ? path : path.parent_path();
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    throw InputError(path.string(), "is a file; give a folder");
  if (!fs::is_directory(folder, error)) {
    check_writable(parent_of(folder), folder);
    if (!fs::create_directory(folder, error) && error)
      throw WorkError(path.string(), "cannot be made: " + error.message());
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(path.string(), std::string("cannot be written to (") + std::strerror(errno) + "); choose another");
}

StagedFile::StagedFile(fs::path final_path) : final_(std::move(final_path)), staged_(final_) { staged_ += ".part"; }

StagedFile::~StagedFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(staged_, ignored);
}

void StagedFile::commit() {
  const int file = open(staged_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool on_disk = file >= 0 && fsync(file) == 0;
  const int why = errno;
  if (file >= 0) close(file);
  if (!on_disk) throw WorkError(final_.string(), std::string("cannot be brought to the disk: ") + std::strerror(why));
  std::error_code error;
  fs::rename(staged_, final_, error);
  if (error) throw WorkError(final_.string(), "cannot be put in place: " + error.message());
  committed_ = true;
}

void write_text(const fs::path& path, const std::string& text) {
  StagedFile file(path);
  std::ofstream out(file.path(), std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) throw WorkError(path.string(), std::string("cannot be written: ") + std::strerror(errno));
  file.commit();
}

}  // namespace tumble::io
