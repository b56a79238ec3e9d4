#include "io/film_file.h"

#include <fmt/format.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/log.h>
#include <libavutil/opt.h>
}

#include <algorithm>
#include <array>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "core/error.h"
#include "io/gif_palette.h"
#include "io/output.h"
#include "io/yuv420.h"

namespace tumble::io {
namespace {

constexpr std::array<std::string_view, 10> kPresets = {"ultrafast", "superfast", "veryfast", "faster",   "fast",
                                                       "medium",    "slow",      "slower",   "veryslow", "placebo"};

std::string reason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(error, text, sizeof text);
  return text;
}

bool has_avx512() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512f");
#else
  return false;
#endif
}

enum class Coding { kH264, kVp9, kGif };

struct Kind {
  Coding coding;
  std::string_view extension;
  const char *muxer, *encoder;
  double worst_crf;
};
constexpr Kind kKinds[] = {{Coding::kH264, ".mp4", "mp4", "libx264", 51},
                           {Coding::kVp9, ".webm", "webm", "libvpx-vp9", 63},
                           {Coding::kGif, ".gif", "gif", "gif", 0}};

const Kind* kind_of(const std::string& path) {
  for (const Kind& kind : kKinds)
    if (path.ends_with(kind.extension)) return &kind;
  return nullptr;
}

const Kind& known_kind_of(const std::string& path) {
  const Kind* kind = kind_of(path);
  if (!kind) throw InputError(path, "is no film's name; give one that ends in .mp4, .webm or .gif");
  return *kind;
}

constexpr std::size_t kPalettePictures = 24;  // what a GIF's colours are chosen by

void check(const std::string& path, const FilmFormat& format) {
  const Kind& kind = known_kind_of(path);
  if (kind.coding == Coding::kGif) {  // it counts time in hundredths, and browsers show anything under two as ten
    if (100 * format.fps_denominator % format.fps_numerator != 0 ||
        format.fps_numerator > 50 * format.fps_denominator) {
      throw InputError(path, fmt::format("{:g} frames per second cannot be told in a GIF, which counts hundredths of a "
                                         "second; give 50, 25, 20, 12.5, 10, 5 ...",
                                         static_cast<double>(format.fps_numerator) / format.fps_denominator));
    }
    return;
  }
  if (format.width < 2 || format.height < 2 || format.width % 2 != 0 || format.height % 2 != 0) {
    throw InputError(path, fmt::format("a film of {}x{} px cannot be coded as yuv420p; width and height must be even",
                                       format.width, format.height));
  }
  if (format.fps_numerator < 1 || format.fps_denominator < 1) {
    throw InputError(path, fmt::format("{}/{} frames per second is not a frame rate; both must be at least 1",
                                       format.fps_numerator, format.fps_denominator));
  }
  if (!(format.crf >= 0 && format.crf <= kind.worst_crf)) {
    throw InputError(path,
                     fmt::format("crf {} is out of range; give 0 (lossless) to {:g}", format.crf, kind.worst_crf));
  }
  if (std::find(kPresets.begin(), kPresets.end(), format.preset) == kPresets.end()) {
    throw InputError(path, fmt::format("preset '{}' is unknown; there are {}", format.preset,
                                       fmt::join(kPresets.begin(), kPresets.end(), ", ")));
  }
}

struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
using Picture = std::unique_ptr<AVFrame, FreeFrame>;

// Pictures on their way to an encoder that works in a thread of its own, while the next ones are drawn. The order of
// pictures, and so the film, is the same with and without it.
class Belt {
 public:
  explicit Belt(std::function<void(const AVFrame*)> work) : work_(std::move(work)), thread_([this] { run(); }) {}
  ~Belt() { stop(); }
  Belt(const Belt&) = delete;
  Belt& operator=(const Belt&) = delete;

  // Waits while the belt is full. Throws what the work threw.
  void put(Picture picture) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kLength || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    waiting_.push_back(std::move(picture));
    changed_.notify_all();
  }

  // Waits until all that was put is done.
  void drain() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return (waiting_.empty() && !is_working_) || failure_; });
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  static constexpr std::size_t kLength = 8;  // enough to bridge a key frame, little enough memory at any size

  void stop() {
    {
      const std::lock_guard lock(mutex_);
      is_stopping_ = true;
      waiting_.clear();
    }
    changed_.notify_all();
    thread_.join();
  }

  void run() {
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return is_stopping_ || !waiting_.empty(); });
      if (is_stopping_) return;
      const Picture picture = std::move(waiting_.front());
      waiting_.pop_front();
      is_working_ = true;
      changed_.notify_all();
      lock.unlock();
      std::exception_ptr failure;
      try {
        work_(picture.get());
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      is_working_ = false;
      if (failure) failure_ = failure;
      changed_.notify_all();
      if (failure) return;
    }
  }

  std::function<void(const AVFrame*)> work_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Picture> waiting_;
  bool is_working_ = false, is_stopping_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it starts when all else is there
};

}  // namespace

struct FilmWriter::Impl {
  Impl(const std::string& path, const FilmFormat& wanted)
      : name(path), format(wanted), kind(known_kind_of(path)), file(path) {}
  ~Impl() {
    belt.reset();  // the encoder must be at rest
    av_packet_free(&packet);
    avcodec_free_context(&encoder);
    if (muxer) avio_closep(&muxer->pb);
    avformat_free_context(muxer);
  }

  // Every call into libav passes here, so that none fails unseen.
  void expect(int result, const char* what) const {
    if (result < 0) throw WorkError(name, fmt::format("{}: {}", what, reason(result)));
  }

  void open();
  void describe_colours();
  AVDictionary* encoder_options() const;
  void put(const Image& image);
  void choose_colours();  // of a GIF, by the pictures so far; then they are coded
  Picture picture_of(const Image& image);
  void encode(const AVFrame* frame);  // null: what the encoder still holds

  std::string name;
  FilmFormat format;
  const Kind& kind;
  StagedFile file;
  AVFormatContext* muxer = nullptr;
  AVCodecContext* encoder = nullptr;
  AVStream* stream = nullptr;
  AVPacket* packet = nullptr;
  std::int64_t frames = 0;
  bool finished = false;
  std::vector<Image> first_pictures;  // of a GIF whose colours are not chosen yet
  std::optional<GifPalette> palette;
  std::unique_ptr<Belt> belt;  // none with one thread
};

void FilmWriter::Impl::open() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_level(AV_LOG_QUIET); });  // rooms do not print

  const AVCodec* codec = avcodec_find_encoder_by_name(kind.encoder);
  if (!codec)
    throw WorkError(name,
                    fmt::format("libavcodec has no {0}; install a libavcodec that was built with it", kind.encoder));
  expect(avformat_alloc_output_context2(&muxer, nullptr, kind.muxer, file.path().c_str()), "cannot be set up");
  encoder = avcodec_alloc_context3(codec);
  stream = avformat_new_stream(muxer, nullptr);
  packet = av_packet_alloc();
  if (!encoder || !stream || !packet) throw WorkError(name, "not enough memory for the encoder");

  const int common = std::gcd(format.fps_numerator, format.fps_denominator);
  const AVRational rate{format.fps_numerator / common, format.fps_denominator / common};
  encoder->width = format.width;
  encoder->height = format.height;
  encoder->pix_fmt = kind.coding == Coding::kGif ? AV_PIX_FMT_PAL8 : AV_PIX_FMT_YUV420P;
  encoder->time_base = av_inv_q(rate);
  encoder->framerate = rate;
  if (kind.coding != Coding::kGif) describe_colours();
  // One thread always: x264's decisions change with its number of threads (motion range, lookahead), and the same
  // frames must give the same bytes.
  encoder->thread_count = 1;
  if (muxer->oformat->flags & AVFMT_GLOBALHEADER) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;

  AVDictionary* options = encoder_options();
  const int opened = avcodec_open2(encoder, codec, &options);
  av_dict_free(&options);
  expect(opened, "its encoder does not take this film");

  expect(avcodec_parameters_from_context(stream->codecpar, encoder), "cannot be described");
  stream->time_base = encoder->time_base;
  stream->avg_frame_rate = rate;

  expect(avio_open(&muxer->pb, file.path().c_str(), AVIO_FLAG_WRITE), "cannot be opened for writing");
  AVDictionary* layout = nullptr;
  if (kind.coding == Coding::kH264) av_dict_set(&layout, "movflags", "+faststart", 0);
  if (kind.coding == Coding::kVp9) {
    av_dict_set(&layout, "cues_to_front", "1", 0);
    av_dict_set(&layout, "fflags", "+bitexact", 0);  // no random number of the file in it
  }
  const int begun = avformat_write_header(muxer, &layout);
  av_dict_free(&layout);
  expect(begun, "its header cannot be written");
}

void FilmWriter::Impl::describe_colours() {
  encoder->color_primaries = AVCOL_PRI_BT709;
  encoder->color_trc = AVCOL_TRC_BT709;
  encoder->colorspace = AVCOL_SPC_BT709;
  encoder->color_range = AVCOL_RANGE_MPEG;
  encoder->chroma_sample_location = AVCHROMA_LOC_CENTER;
}

AVDictionary* FilmWriter::Impl::encoder_options() const {
  AVDictionary* options = nullptr;
  if (kind.coding == Coding::kGif) return options;
  av_dict_set(&options, "crf", fmt::format("{}", format.crf).c_str(), 0);
  if (kind.coding == Coding::kVp9) {
    encoder->bit_rate = 0;  // quality alone decides
    av_dict_set(&options, "deadline", "realtime", 0);
    av_dict_set(&options, "cpu-used", "5", 0);
    return options;
  }
  av_dict_set(&options, "preset", format.preset.c_str(), 0);
  // x264 0.164's AVX-512 path of macroblock-tree reads memory that it never wrote: the same pictures give other bytes
  // from run to run. Its AVX2 path gives the same bytes as all older ones, at the same speed.
  if (has_avx512()) av_dict_set(&options, "x264-params", "asm=avx2", 0);
  return options;
}

void FilmWriter::Impl::put(const Image& image) {
  Picture picture = picture_of(image);
  if (belt) {
    belt->put(std::move(picture));
  } else {
    encode(picture.get());
  }
}

void FilmWriter::Impl::choose_colours() {
  palette.emplace(first_pictures);
  for (const Image& image : std::exchange(first_pictures, {})) put(image);
}

Picture FilmWriter::Impl::picture_of(const Image& image) {
  Picture picture(av_frame_alloc());
  if (!picture) throw WorkError(name, "no memory for a picture");
  picture->format = encoder->pix_fmt;
  picture->width = format.width;
  picture->height = format.height;
  expect(av_frame_get_buffer(picture.get(), 0), "no memory for a picture");
  if (palette) {
    palette->map(image, picture->data[0], picture->linesize[0]);
    std::memcpy(picture->data[1], palette->argb().data(), sizeof(palette->argb()));
  } else {
    yuv420_from_rgba(image, {picture->data[0], picture->data[1], picture->data[2], picture->linesize[0],
                             picture->linesize[1], picture->linesize[2]});
  }
  picture->pts = frames++;
  return picture;
}

void FilmWriter::Impl::encode(const AVFrame* frame) {
  expect(avcodec_send_frame(encoder, frame), "a frame cannot be encoded");
  while (true) {
    const int got = avcodec_receive_packet(encoder, packet);
    if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
    expect(got, "a frame cannot be encoded");
    packet->stream_index = stream->index;
    packet->duration = 1;  // in frames: stated, so that no muxer has to guess the last one's
    av_packet_rescale_ts(packet, encoder->time_base, stream->time_base);
    expect(av_interleaved_write_frame(muxer, packet), "cannot be written");
  }
}

bool is_film_name(const std::string& path) { return kind_of(path) != nullptr; }

FilmFormat usual_format(const std::string& path) {
  FilmFormat format;
  switch (known_kind_of(path).coding) {
    case Coding::kH264:
      break;
    case Coding::kVp9:
      format.crf = 36;  // looks as x264's 20 does
      break;
    case Coding::kGif:
      format.width = 640;
      format.height = 360;
      format.fps_numerator = 25;
      break;
  }
  return format;
}

FilmWriter::FilmWriter(const std::string& path, const FilmFormat& format) {
  check(path, format);
  impl_ = std::make_unique<Impl>(path, format);
  Impl& my = *impl_;
  my.open();
  if (format.threads != 1) my.belt = std::make_unique<Belt>([&my](const AVFrame* frame) { my.encode(frame); });
}

FilmWriter::~FilmWriter() = default;

void FilmWriter::write(const Image& image) {
  Impl& my = *impl_;
  if (image.width != my.format.width || image.height != my.format.height) {
    throw WorkError(my.name, fmt::format("a picture of {}x{} px came into a film of {}x{} px", image.width,
                                         image.height, my.format.width, my.format.height));
  }
  if (my.kind.coding == Coding::kGif && !my.palette) {
    my.first_pictures.push_back(image);
    if (my.first_pictures.size() >= kPalettePictures) my.choose_colours();
  } else {
    my.put(image);
  }
}

void FilmWriter::finish() {
  Impl& my = *impl_;
  if (my.finished) return;
  if (!my.first_pictures.empty()) my.choose_colours();
  if (my.frames == 0) throw WorkError(my.name, "a film needs at least one frame");
  if (my.belt) my.belt->drain();
  my.encode(nullptr);
  my.expect(av_write_trailer(my.muxer), "its index cannot be written");
  my.expect(avio_closep(&my.muxer->pb), "cannot be closed");
  my.file.commit();
  my.finished = true;
}

}  // namespace tumble::io
