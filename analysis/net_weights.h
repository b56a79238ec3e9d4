#pragma once
#include <span>

namespace tumble::analysis {

// What training left of the networks (conv_net.h's order).
std::span<const float> ball_net_weights();
std::span<const float> ball_refiner_weights();

}  // namespace tumble::analysis
