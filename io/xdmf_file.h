#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace tumble::io {

// RUN.xdmf beside RUN.h5, through which ParaView (its XDMFReader, format version 2) opens the run.
void write_xdmf(const std::filesystem::path& run_file, std::int64_t frame_count, std::size_t balls);

}  // namespace tumble::io
