#pragma once
#include <filesystem>
#include <string>
#include <vector>

// Outputs appear whole or not at all: written beside their final name, then renamed.
namespace tumble::io {

// Throws InputError where `path` cannot become an output: the parent folder does not exist or is not writable, it is
// itself a folder, a device or a pipe, or it exists and `force` is false.
void check_output_file(const std::filesystem::path& path, bool force);

// Throws InputError where the output is the very file that is read: even by force that would destroy it.
void check_not_input(const std::filesystem::path& output, const std::filesystem::path& input);

// Throws InputError where two outputs of one command have the same name: the later would replace the earlier. Empty
// names do not count.
void check_apart(const std::vector<std::filesystem::path>& outputs);

// Makes the folder if it is not there (its parent must exist); throws InputError where it cannot be written to.
void make_output_folder(const std::filesystem::path& path);

// A file under construction beside its final name. Destroyed before commit(), it removes what was written.
class StagedFile {
 public:
  explicit StagedFile(std::filesystem::path final_path);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  const std::filesystem::path& path() const { return staged_; }  // write here
  void commit();                                                 // flush to the disk, rename

 private:
  std::filesystem::path final_, staged_;
  bool committed_ = false;
};

// The whole text at once, staged. Throws WorkError with the path and the system's reason.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace tumble::io
