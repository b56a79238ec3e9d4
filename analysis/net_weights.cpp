#include "analysis/net_weights.h"

// The files as they are, put into the program by the assembler.
#define TUMBLE_EMBED(name, file)    \
  asm(".section .rodata\n"          \
      ".balign 64\n"                \
      ".global " name "\n" name     \
      ":\n"                         \
      ".incbin \"" file             \
      "\"\n"                        \
      ".global " name "_end\n" name \
      "_end:\n"                     \
      ".previous\n")

TUMBLE_EMBED("tumble_ball_net", TUMBLE_NETS "/ball_net.weights");
TUMBLE_EMBED("tumble_ball_refiner", TUMBLE_NETS "/ball_refiner.weights");

extern "C" const float tumble_ball_net[], tumble_ball_net_end[];
extern "C" const float tumble_ball_refiner[], tumble_ball_refiner_end[];

namespace tumble::analysis {

std::span<const float> ball_net_weights() { return {tumble_ball_net, tumble_ball_net_end}; }
std::span<const float> ball_refiner_weights() { return {tumble_ball_refiner, tumble_ball_refiner_end}; }

}  // namespace tumble::analysis
