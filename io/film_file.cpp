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
#include <vector>

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

// Every call into libav passes here, so that none fails unseen.
void expect(int result, const std::string& name, const char* what) {
  if (result < 0) throw WorkError(name, fmt::format("{}: {}", what, reason(result)));
}

AVRational rate_of(const FilmFormat& format) {
  const int common = std::gcd(format.fps_numerator, format.fps_denominator);
  return {format.fps_numerator / common, format.fps_denominator / common};
}

struct FreeEncoder {
  void operator()(AVCodecContext* encoder) const { avcodec_free_context(&encoder); }
};
using Encoder = std::unique_ptr<AVCodecContext, FreeEncoder>;

struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
using Packet = std::unique_ptr<AVPacket, FreePacket>;

void describe_colours(AVCodecContext& encoder) {
  encoder.color_primaries = AVCOL_PRI_BT709;
  encoder.color_trc = AVCOL_TRC_BT709;
  encoder.colorspace = AVCOL_SPC_BT709;
  encoder.color_range = AVCOL_RANGE_MPEG;
  encoder.chroma_sample_location = AVCHROMA_LOC_CENTER;
}

std::string x264_params(const FilmFormat& format) {
  std::vector<std::string> params;
  // x264 0.164's AVX-512 path of macroblock-tree reads memory that it never wrote: the same pictures give other bytes
  // from run to run. Its AVX2 path gives the same bytes as all older ones, at the same speed.
  if (has_avx512()) params.emplace_back("asm=avx2");
  // Colours carry numbers in our pictures. From `fast` on x264 itself spends more on them than on grey; before, it is
  // told to: most of the loss from medium to veryfast (SSIM) is made good by 6 % more bytes and no time.
  const auto fast = std::find(kPresets.begin(), kPresets.end(), "fast");
  if (std::find(kPresets.begin(), fast, format.preset) != fast) params.emplace_back("chroma-qp-offset=-4");
  return fmt::format("{}", fmt::join(params, ":"));
}

AVDictionary* encoder_options(Coding coding, const FilmFormat& format) {
  AVDictionary* options = nullptr;
  if (coding == Coding::kGif) return options;
  av_dict_set(&options, "crf", fmt::format("{}", format.crf).c_str(), 0);
  if (coding == Coding::kVp9) {
    av_dict_set(&options, "b", "0", 0);  // quality alone decides
    av_dict_set(&options, "deadline", "realtime", 0);
    av_dict_set(&options, "cpu-used", "5", 0);
    return options;
  }
  av_dict_set(&options, "preset", format.preset.c_str(), 0);
  av_dict_set(&options, "x264-params", x264_params(format).c_str(), 0);
  return options;
}

Encoder open_encoder(const std::string& name, const FilmFormat& format) {
  const Kind& kind = known_kind_of(name);
  const AVCodec* codec = avcodec_find_encoder_by_name(kind.encoder);
  if (!codec)
    throw WorkError(name,
                    fmt::format("libavcodec has no {}; install a libavcodec that was built with it", kind.encoder));
  Encoder encoder(avcodec_alloc_context3(codec));
  if (!encoder) throw WorkError(name, "not enough memory for the encoder");
  encoder->width = format.width;
  encoder->height = format.height;
  encoder->pix_fmt = kind.coding == Coding::kGif ? AV_PIX_FMT_PAL8 : AV_PIX_FMT_YUV420P;
  encoder->framerate = rate_of(format);
  encoder->time_base = av_inv_q(encoder->framerate);
  if (kind.coding != Coding::kGif) describe_colours(*encoder);
  // One thread always: x264's decisions change with its number of threads (motion range, lookahead), and the same
  // frames must give the same bytes. Parts of a film are what is encoded side by side.
  encoder->thread_count = 1;
  if (kind.coding == Coding::kH264) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // as MP4 has it

  AVDictionary* options = encoder_options(kind.coding, format);
  const int opened = avcodec_open2(encoder.get(), codec, &options);
  av_dict_free(&options);
  expect(opened, name, "its encoder does not take this film");
  return encoder;
}

}  // namespace

struct FilmPart::Impl {
  Impl(const std::string& film, const FilmFormat& wanted, Encoder opened, std::int64_t first)
      : name(film), format(wanted), encoder(std::move(opened)), next(first) {}

  Picture new_picture() const;
  void fill(AVFrame& picture, const Image& image);  // and gives it its time
  // `use(image)` of all that can be coded now: a GIF's first pictures wait until its colours are chosen by them.
  template <class Use>
  void each_ready(const Image& image, const Use& use);
  template <class Use>
  void each_waiting(const Use& use);    // there are no more
  void draw(const Image& image);        // and encodes it at once
  void encode(const AVFrame* picture);  // null: what the encoder still holds

  std::string name;
  FilmFormat format;
  Encoder encoder;
  std::int64_t next = 0;              // the film's frame that comes next
  Picture picture;                    // used again for every frame
  std::vector<Image> first_pictures;  // of a GIF whose colours are not chosen yet
  std::optional<GifPalette> palette;
  std::vector<Packet> packets;
};

Picture FilmPart::Impl::new_picture() const {
  Picture fresh(av_frame_alloc());
  if (!fresh) throw WorkError(name, "no memory for a picture");
  fresh->format = encoder->pix_fmt;
  fresh->width = format.width;
  fresh->height = format.height;
  expect(av_frame_get_buffer(fresh.get(), 0), name, "no memory for a picture");
  return fresh;
}

template <class Use>
void FilmPart::Impl::each_ready(const Image& image, const Use& use) {
  if (encoder->pix_fmt != AV_PIX_FMT_PAL8 || palette) return use(image);
  first_pictures.push_back(image);
  if (first_pictures.size() >= kPalettePictures) each_waiting(use);
}

template <class Use>
void FilmPart::Impl::each_waiting(const Use& use) {
  if (first_pictures.empty()) return;
  palette.emplace(first_pictures);
  for (const Image& image : std::exchange(first_pictures, {})) use(image);
}

void FilmPart::Impl::draw(const Image& image) {
  if (!picture) picture = new_picture();
  fill(*picture, image);
  encode(picture.get());
}

void FilmPart::Impl::fill(AVFrame& into, const Image& image) {
  if (image.width != format.width || image.height != format.height) {
    throw WorkError(name, fmt::format("a picture of {}x{} px came into a film of {}x{} px", image.width, image.height,
                                      format.width, format.height));
  }
  expect(av_frame_make_writable(&into), name, "no memory for a picture");
  if (palette) {
    palette->map(image, into.data[0], into.linesize[0]);
    std::memcpy(into.data[1], palette->argb().data(), sizeof(palette->argb()));
  } else {
    yuv420_from_rgba(image,
                     {into.data[0], into.data[1], into.data[2], into.linesize[0], into.linesize[1], into.linesize[2]});
  }
  into.pts = next++;
}

void FilmPart::Impl::encode(const AVFrame* frame) {
  expect(avcodec_send_frame(encoder.get(), frame), name, "a frame cannot be encoded");
  while (true) {
    Packet packet(av_packet_alloc());
    if (!packet) throw WorkError(name, "not enough memory for the encoder");
    const int got = avcodec_receive_packet(encoder.get(), packet.get());
    if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
    expect(got, name, "a frame cannot be encoded");
    packets.push_back(std::move(packet));
  }
}

FilmPart::FilmPart(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FilmPart::FilmPart(FilmPart&&) noexcept = default;
FilmPart& FilmPart::operator=(FilmPart&&) noexcept = default;
FilmPart::~FilmPart() = default;

void FilmPart::write(const Image& image) {
  Impl& my = *impl_;
  my.each_ready(image, [&my](const Image& ready) { my.draw(ready); });
}

void FilmPart::finish() {
  impl_->each_waiting([this](const Image& image) { impl_->draw(image); });
  impl_->encode(nullptr);
  impl_->encoder.reset();  // a finished part may wait for its turn: its packets are all that it needs
  impl_->picture.reset();
}

struct FilmWriter::Impl {
  Impl(const std::string& path, const FilmFormat& wanted) : name(path), format(wanted), file(path) {}
  ~Impl() {
    belt.reset();  // the encoder must be at rest
    if (muxer) avio_closep(&muxer->pb);
    avformat_free_context(muxer);
  }

  void open();
  Encoder take_encoder();
  void mux(std::vector<Packet>& packets);
  void put(const Image& image);  // of write()

  std::string name;
  FilmFormat format;
  StagedFile file;
  AVFormatContext* muxer = nullptr;
  AVStream* stream = nullptr;
  std::mutex mutex;
  Encoder opened;                          // told the muxer what the film is like; the first part takes it
  std::unique_ptr<FilmPart::Impl> serial;  // of write(): the whole film is one part
  std::unique_ptr<Belt> belt;              // of write(), with several threads
  std::int64_t frames = 0;
  bool finished = false;
};

void FilmWriter::Impl::open() {
  static std::once_flag once;
  std::call_once(once, [] { av_log_set_level(AV_LOG_QUIET); });  // rooms do not print
  opened = open_encoder(name, format);
  expect(avformat_alloc_output_context2(&muxer, nullptr, known_kind_of(name).muxer, file.path().c_str()), name,
         "cannot be set up");
  stream = avformat_new_stream(muxer, nullptr);
  if (!stream) throw WorkError(name, "not enough memory for the film");
  expect(avcodec_parameters_from_context(stream->codecpar, opened.get()), name, "cannot be described");
  stream->avg_frame_rate = rate_of(format);
  stream->time_base = av_inv_q(stream->avg_frame_rate);

  expect(avio_open(&muxer->pb, file.path().c_str(), AVIO_FLAG_WRITE), name, "cannot be opened for writing");
  const Coding coding = known_kind_of(name).coding;
  AVDictionary* layout = nullptr;
  if (coding == Coding::kH264) av_dict_set(&layout, "movflags", "+faststart", 0);
  if (coding == Coding::kVp9) {
    av_dict_set(&layout, "cues_to_front", "1", 0);
    av_dict_set(&layout, "fflags", "+bitexact", 0);  // no random number of the file in it
  }
  const int begun = avformat_write_header(muxer, &layout);
  av_dict_free(&layout);
  expect(begun, name, "its header cannot be written");
}

Encoder FilmWriter::Impl::take_encoder() {
  {
    const std::lock_guard lock(mutex);
    if (opened) return std::move(opened);
  }
  return open_encoder(name, format);
}

void FilmWriter::Impl::mux(std::vector<Packet>& packets) {
  for (const Packet& packet : packets) {
    packet->stream_index = stream->index;
    packet->duration = 1;  // in frames: stated, so that no muxer has to guess the last one's
    av_packet_rescale_ts(packet.get(), av_inv_q(rate_of(format)), stream->time_base);
    expect(av_interleaved_write_frame(muxer, packet.get()), name, "cannot be written");
  }
  packets.clear();
}

void FilmWriter::Impl::put(const Image& image) {
  FilmPart::Impl& part = *serial;
  if (belt) {
    Picture picture = part.new_picture();
    part.fill(*picture, image);
    belt->put(std::move(picture));
  } else {
    part.draw(image);
    mux(part.packets);
  }
  frames = part.next;
}

bool is_film_name(const std::string& path) { return kind_of(path) != nullptr; }

bool can_be_cut(const std::string& path) { return known_kind_of(path).coding != Coding::kGif; }

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
  impl_->open();
}

FilmWriter::~FilmWriter() = default;

FilmPart FilmWriter::part(std::int64_t first_frame) {
  Impl& my = *impl_;
  return FilmPart(std::make_unique<FilmPart::Impl>(my.name, my.format, my.take_encoder(), first_frame));
}

void FilmWriter::append(FilmPart part) {
  impl_->frames = part.impl_->next;
  impl_->mux(part.impl_->packets);
}

void FilmWriter::write(const Image& image) {
  Impl& my = *impl_;
  if (!my.serial) {
    my.serial = std::make_unique<FilmPart::Impl>(my.name, my.format, my.take_encoder(), 0);
    if (my.format.threads != 1) {
      my.belt = std::make_unique<Belt>([&my](const AVFrame* frame) {
        my.serial->encode(frame);
        my.mux(my.serial->packets);
      });
    }
  }
  my.serial->each_ready(image, [&my](const Image& ready) { my.put(ready); });
}

void FilmWriter::finish() {
  Impl& my = *impl_;
  if (my.finished) return;
  if (my.serial) my.serial->each_waiting([&my](const Image& image) { my.put(image); });
  if (my.frames == 0) throw WorkError(my.name, "a film needs at least one frame");
  if (my.belt) my.belt->drain();
  if (my.serial) {
    my.serial->encode(nullptr);
    my.mux(my.serial->packets);
  }
  expect(av_write_trailer(my.muxer), my.name, "its index cannot be written");
  expect(avio_closep(&my.muxer->pb), my.name, "cannot be closed");
  my.file.commit();
  my.finished = true;
}

}  // namespace tumble::io
