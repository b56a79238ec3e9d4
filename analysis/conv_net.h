#pragma once
#include <cmath>
#include <functional>
#include <oneapi/dnnl/dnnl.hpp>
#include <span>
#include <vector>

namespace tumble::analysis {

// What a network's answer to a yes-or-no question means as a probability.
inline double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

// A convolutional network with fixed weights, for inputs of one shape, built layer by layer and then run. A thin cover
// of oneDNN: for the room's own nets alone. It stays in the thread that calls it.
class ConvNet {
 public:
  using Memory = dnnl::memory;
  using Dims = dnnl::memory::dims;

  explicit ConvNet(std::span<const float> weights);  // in the order of the layers: (out, in, rows, columns), biases

  struct Layer {
    int channels = 0;  // out
    int size = 3;      // rows and columns of the kernel
    int stride = 1, dilation = 1;
    bool padded = true;  // keeps the shape, but for the stride
    bool rectify = true;
  };
  // Dims are batch, channels, rows, columns. Plain memory holds the channels of a place side by side, as pictures do:
  // also what convolutions like best where there is AVX-512.
  Memory plain(const Dims& dims);
  Memory as_plain(const Memory& from);  // itself where it is plain already
  Memory copy(const Memory& from);
  Memory convolve(const Memory& from, const Layer& layer);
  void add_convolved(const Memory& from, const Memory& onto, const Layer& layer);
  void call(std::function<void()> step);
  void check_complete() const;  // throws WorkError where weights are left over

  void run();
  static float* data_of(const Memory& m) { return static_cast<float*>(m.get_data_handle()); }

 private:
  void reorder(const Memory& from, const Memory& to);
  Memory next_weights(const Dims& dims, Memory::format_tag tag);
  void convolve(const Memory& from, const Layer& layer, bool add, Memory& to);

  dnnl::engine engine_;
  dnnl::stream stream_;
  std::span<const float> weights_;
  std::vector<std::function<void()>> steps_;
};

}  // namespace tumble::analysis
