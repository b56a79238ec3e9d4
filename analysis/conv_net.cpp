#include "analysis/conv_net.h"

#include <omp.h>

#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "core/error.h"

namespace tumble::analysis {
namespace {

constexpr auto kFloat = dnnl::memory::data_type::f32;
constexpr auto kAny = dnnl::memory::format_tag::any;

}  // namespace

ConvNet::ConvNet(std::span<const float> weights)
    : engine_(dnnl::engine::kind::cpu, 0), stream_(engine_), weights_(weights) {
  omp_set_num_threads(1);  // of this thread's convolutions: callers look at pictures side by side
}

ConvNet::Memory ConvNet::plain(const Dims& dims) { return Memory({dims, kFloat, Memory::format_tag::nhwc}, engine_); }

ConvNet::Memory ConvNet::as_plain(const Memory& from) {
  const Memory to = plain(from.get_desc().dims());
  if (from.get_desc() == to.get_desc()) return from;
  reorder(from, to);
  return to;
}

ConvNet::Memory ConvNet::copy(const Memory& from) {
  const Memory to(from.get_desc(), engine_);
  call([from, to, bytes = from.get_desc().get_size()] { std::memcpy(data_of(to), data_of(from), bytes); });
  return to;
}

void ConvNet::reorder(const Memory& from, const Memory& to) {
  steps_.emplace_back([this, primitive = dnnl::reorder(from, to),
                       arguments = std::unordered_map<int, Memory>{{DNNL_ARG_FROM, from}, {DNNL_ARG_TO, to}}] {
    primitive.execute(stream_, arguments);
  });
}

ConvNet::Memory ConvNet::convolve(const Memory& from, const Layer& layer) {
  Memory to;
  convolve(from, layer, false, to);
  return to;
}

void ConvNet::add_convolved(const Memory& from, const Memory& onto, const Layer& layer) {
  Memory to = onto;
  convolve(from, layer, true, to);
}

void ConvNet::call(std::function<void()> step) {
  steps_.emplace_back([this, step = std::move(step)] {
    stream_.wait();
    step();
  });
}

void ConvNet::check_complete() const {
  if (!weights_.empty()) throw WorkError("conv_net", "there are more weights than the layers take");
}

void ConvNet::run() {
  omp_set_num_threads(1);
  for (const auto& step : steps_) step();
  stream_.wait();
}

ConvNet::Memory ConvNet::next_weights(const Dims& dims, Memory::format_tag tag) {
  Memory m({dims, kFloat, tag}, engine_);
  const std::size_t n = m.get_desc().get_size() / sizeof(float);
  if (weights_.size() < n) throw WorkError("conv_net", "the weights end before the layers");
  std::copy_n(weights_.begin(), n, data_of(m));
  weights_ = weights_.subspan(n);
  return m;
}

void ConvNet::convolve(const Memory& from, const Layer& layer, bool add, Memory& to) {
  const Dims in = from.get_desc().dims();
  const int reach = layer.dilation * (layer.size - 1), margin = layer.padded ? reach / 2 : 0;
  const auto out = [&](auto n) { return (n + 2 * margin - reach - 1) / layer.stride + 1; };
  const Dims out_dims{in[0], layer.channels, out(in[2]), out(in[3])};
  const Dims weight_dims{layer.channels, in[1], layer.size, layer.size}, bias_dims{layer.channels};
  const Dims strides{layer.stride, layer.stride}, dilates{layer.dilation - 1, layer.dilation - 1}, pad{margin, margin};
  dnnl::post_ops after;
  if (add) after.append_sum(1.0f);
  if (layer.rectify) after.append_eltwise(1.0f, dnnl::algorithm::eltwise_relu, 0.0f, 0.0f);
  dnnl::primitive_attr attributes;
  attributes.set_post_ops(after);
  const dnnl::convolution_forward::desc what(
      dnnl::prop_kind::forward_inference, dnnl::algorithm::convolution_direct, Memory::desc(in, kFloat, kAny),
      Memory::desc(weight_dims, kFloat, kAny), Memory::desc(bias_dims, kFloat, kAny),
      add ? to.get_desc() : Memory::desc(out_dims, kFloat, kAny), strides, dilates, pad, pad);
  const dnnl::convolution_forward::primitive_desc chosen(what, attributes, engine_);
  Memory weights = next_weights(weight_dims, Memory::format_tag::oihw);
  const Memory bias = next_weights(bias_dims, Memory::format_tag::x);
  if (chosen.weights_desc() != weights.get_desc()) {
    Memory packed(chosen.weights_desc(), engine_);
    dnnl::reorder(weights, packed).execute(stream_, weights, packed);
    stream_.wait();
    weights = packed;
  }
  Memory source = from;
  if (chosen.src_desc() != from.get_desc()) {
    source = Memory(chosen.src_desc(), engine_);
    reorder(from, source);
  }
  if (!add) to = Memory(chosen.dst_desc(), engine_);
  const dnnl::convolution_forward primitive(chosen);
  steps_.emplace_back(
      [this, primitive,
       arguments = std::unordered_map<int, Memory>{
           {DNNL_ARG_SRC, source}, {DNNL_ARG_WEIGHTS, weights}, {DNNL_ARG_BIAS, bias}, {DNNL_ARG_DST, to}}] {
        primitive.execute(stream_, arguments);
      });
}

}  // namespace tumble::analysis
