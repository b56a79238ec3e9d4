#pragma once
#include <filesystem>

#include "core/frame.h"

namespace tumble::io {

// RUN.xdmf beside RUN.h5, through which ParaView (its XDMFReader, format version 2) opens the run.
void write_xdmf(const std::filesystem::path& run_file, const RunSetup& setup);

}  // namespace tumble::io
