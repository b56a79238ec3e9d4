#include "io/film_file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}
#include <malloc.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <csignal>
#include <thread>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/yuv420.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

// A bright square that moves over a slope of colours.
Image picture(int width, int height, int at) {
  Image image(width, height);
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      std::uint8_t* p = image.row(v) + 4 * u;
      const bool square = u >= 3 * at && u < 3 * at + 30 && v >= 20 && v < 50;
      p[0] = static_cast<std::uint8_t>(square ? 250 : 40 + u / 4);
      p[1] = static_cast<std::uint8_t>(square ? 240 : 60 + v / 4);
      p[2] = static_cast<std::uint8_t>(square ? 200 : 90);
      p[3] = 255;
    }
  }
  return image;
}

Image plain(int r, int g, int b) {
  Image image(64, 64);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    image.rgba[i] = static_cast<std::uint8_t>(r);
    image.rgba[i + 1] = static_cast<std::uint8_t>(g);
    image.rgba[i + 2] = static_cast<std::uint8_t>(b);
  }
  return image;
}

FilmFormat small() {
  FilmFormat format;
  format.width = 160;
  format.height = 96;
  return format;
}

void write_film(const std::string& path, const FilmFormat& format, int frames) {
  FilmWriter film(path, format);
  for (int i = 0; i < frames; ++i) film.write(picture(format.width, format.height, i));
  film.finish();
}

// What a player sees, read with libav and not with our own code.
struct Played {
  std::vector<std::vector<std::uint8_t>> luma;  // of each frame, row by row
  std::vector<std::int64_t> time;               // of each frame, in frames
  std::array<int, 3> middle{};                  // Y, Cb, Cr in the middle of the first frame
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  AVRational rate{0, 1};
  double duration = 0;  // [s]
};

Played play(const std::string& path) {
  Played played;
  AVFormatContext* file = nullptr;
  if (avformat_open_input(&file, path.c_str(), nullptr, nullptr) < 0) return played;
  avformat_find_stream_info(file, nullptr);
  const AVStream* stream = file->streams[0];
  AVCodecContext* decoder = avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(decoder, stream->codecpar);
  avcodec_open2(decoder, decoder->codec, nullptr);
  played.matrix = stream->codecpar->color_space;
  played.range = stream->codecpar->color_range;
  played.rate = stream->avg_frame_rate;
  played.duration = static_cast<double>(file->duration) / AV_TIME_BASE;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  const auto take = [&] {
    while (avcodec_receive_frame(decoder, frame) == 0) {
      std::vector<std::uint8_t> rows;
      for (int v = 0; v < frame->height; ++v) {
        const std::uint8_t* row = frame->data[0] + v * frame->linesize[0];
        rows.insert(rows.end(), row, row + frame->width);
      }
      if (played.luma.empty()) {
        const int x = frame->width / 2, y = frame->height / 2;
        played.middle = {frame->data[0][y * frame->linesize[0] + x], frame->data[1][y / 2 * frame->linesize[1] + x / 2],
                         frame->data[2][y / 2 * frame->linesize[2] + x / 2]};
      }
      played.luma.push_back(rows);
      played.time.push_back(av_rescale_q(frame->pts, stream->time_base, av_inv_q(played.rate)));
    }
  };
  while (av_read_frame(file, packet) == 0) {
    avcodec_send_packet(decoder, packet);
    av_packet_unref(packet);
    take();
  }
  avcodec_send_packet(decoder, nullptr);
  take();
  av_packet_free(&packet);
  av_frame_free(&frame);
  avcodec_free_context(&decoder);
  avformat_close_input(&file);
  return played;
}

class FilmFile : public InFolder {
 protected:
  std::string path() const { return (folder_ / "film.mp4").string(); }
  bool folder_is_empty() const { return std::filesystem::is_empty(folder_); }
};

TEST_F(FilmFile, HoldsEveryFrameAtItsExactTime) {
  FilmFormat format = small();
  for (const auto& [numerator, denominator] : {std::pair{60, 1}, {30, 1}, {30000, 1001}, {25, 2}}) {
    format.fps_numerator = numerator;
    format.fps_denominator = denominator;
    write_film(path(), format, 37);
    const Played played = play(path());
    ASSERT_EQ(played.luma.size(), 37u);
    for (int i = 0; i < 37; ++i) EXPECT_EQ(played.time[static_cast<std::size_t>(i)], i);
    EXPECT_EQ(played.rate.num * static_cast<std::int64_t>(denominator),
              played.rate.den * static_cast<std::int64_t>(numerator));
    EXPECT_NEAR(played.duration, 37.0 * denominator / numerator, 1e-3);  // the last frame has its time too
  }
}

TEST_F(FilmFile, GivesBackThePictures) {
  FilmFormat format = small();
  format.crf = 5;
  write_film(path(), format, 20);
  const Played played = play(path());
  ASSERT_EQ(played.luma.size(), 20u);
  for (int i = 0; i < 20; ++i) {
    const Image image = picture(format.width, format.height, i);
    double squares = 0;
    for (std::size_t k = 0; k < played.luma[0].size(); ++k) {
      const std::uint8_t* p = image.rgba.data() + 4 * k;
      const double y = 16 + 219.0 / 255 * (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
      squares += std::pow(y - played.luma[static_cast<std::size_t>(i)][k], 2);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(played.luma[0].size())), 1.5) << "frame " << i;
  }
}

// Saturated colours tell BT.709 from BT.601 and limited from full range.
TEST_F(FilmFile, SaysWhichColoursItMeans) {
  FilmFormat format = small();
  format.width = format.height = 64;
  format.crf = 1;
  const std::vector<std::pair<Image, std::array<int, 3>>> colours = {{plain(255, 0, 0), {63, 102, 240}},
                                                                     {plain(0, 255, 0), {173, 42, 26}},
                                                                     {plain(0, 0, 255), {32, 240, 118}},
                                                                     {plain(255, 255, 255), {235, 128, 128}}};
  for (const auto& [image, expected] : colours) {
    FilmWriter film(path(), format);
    film.write(image);
    film.finish();
    const Played played = play(path());
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(played.middle[c], expected[c], 2) << c;
    EXPECT_EQ(played.matrix, AVCOL_SPC_BT709);
    EXPECT_EQ(played.range, AVCOL_RANGE_MPEG);
  }
}

// Nor on what memory held before: the C library fills fresh memory with another byte each time.
TEST_F(FilmFile, BytesDoNotDependOnThreadsOrLeftovers) {
  FilmFormat format = small();
  std::vector<std::string> films;
  int filling = 1;
  for (const int threads : {1, 2, 4, 0}) {
    format.threads = threads;
    mallopt(M_PERTURB, filling);
    filling += 84;
    write_film(path(), format, 60);
    films.push_back(bytes_of(path()));
  }
  mallopt(M_PERTURB, 0);
  EXPECT_GT(films[0].size(), 1000u);
  for (const std::string& film : films) EXPECT_TRUE(film == films[0]);
}

// Parts filled side by side or one by one, the last first: the same film, with each frame in its place.
TEST_F(FilmFile, IsJoinedFromParts) {
  constexpr int kFrames = 50, kLength = 20;
  const auto write = [&](bool side_by_side) {
    FilmWriter film(path(), small());
    std::vector<FilmPart> parts;
    for (int first = 0; first < kFrames; first += kLength) parts.push_back(film.part(first));
    const auto fill = [&](std::size_t k) {
      for (int i = int(k) * kLength; i < std::min(kFrames, (int(k) + 1) * kLength); ++i)
        parts[k].write(picture(160, 96, i));
      parts[k].finish();
    };
    std::vector<std::thread> threads;
    for (std::size_t k = parts.size(); k-- > 0;) {
      if (side_by_side)
        threads.emplace_back(fill, k);
      else
        fill(k);
    }
    for (std::thread& thread : threads) thread.join();
    for (FilmPart& part : parts) film.append(std::move(part));
    film.finish();
    return bytes_of(path());
  };
  EXPECT_TRUE(write(false) == write(true));
  const Played played = play(path());
  ASSERT_EQ(played.luma.size(), std::size_t{kFrames});
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_EQ(played.time[static_cast<std::size_t>(i)], i);
    const auto at = [&](int u) { return int(played.luma[static_cast<std::size_t>(i)][std::size_t(35 * 160 + u)]); };
    if (3 * i + 32 >= 160) continue;
    EXPECT_GT(at(3 * i + 4), at(3 * i + 32) + 40) << i;  // the square, and what it has not reached
  }
}

TEST_F(FilmFile, HasItsIndexInFront) {
  write_film(path(), small(), 10);
  const std::string bytes = bytes_of(path());
  std::string order;
  for (std::size_t at = 0; at + 8 <= bytes.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(bytes[at + i]);
    order += bytes.substr(at + 4, 4) + " ";
    ASSERT_GE(size, 8u);
    at += size;
  }
  EXPECT_EQ(order, "ftyp moov free mdat ");
}

TEST_F(FilmFile, LeavesNothingWhenUnfinished) {
  {
    FilmWriter film(path(), small());
    for (int i = 0; i < 30; ++i) film.write(picture(160, 96, i));
    EXPECT_FALSE(std::filesystem::exists(path()));
  }
  EXPECT_TRUE(folder_is_empty());
  {
    FilmWriter film(path(), small());
    EXPECT_THROW(film.finish(), WorkError);  // no frame at all
  }
  EXPECT_TRUE(folder_is_empty());
}

TEST_F(FilmFile, RefusesWhatX264CannotDo) {
  const auto refuses = [&](auto change, const std::string& word) {
    FilmFormat format = small();
    change(format);
    try {
      FilmWriter film(path(), format);
      ADD_FAILURE() << word;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  refuses([](FilmFormat& f) { f.width = 161; }, "even");
  refuses([](FilmFormat& f) { f.preset = "quick"; }, "veryfast");
  refuses([](FilmFormat& f) { f.crf = 60; }, "51");
  refuses([](FilmFormat& f) { f.fps_denominator = 0; }, "frame rate");
  EXPECT_TRUE(folder_is_empty());
  EXPECT_THROW(FilmWriter((folder_ / "missing" / "film.mp4").string(), small()), WorkError);
}

// A disk that is full, by the limit on file sizes: the same failure of write() at the same places.
TEST_F(FilmFile, ReportsAFullDisk) {
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  write_film(path(), small(), 60);
  const auto whole = static_cast<rlim_t>(std::filesystem::file_size(path()));
  std::filesystem::remove(path());
  for (const int threads : {1, 2}) {
    FilmFormat format = small();
    format.threads = threads;
    for (const rlim_t room : {whole / 50, whole / 2, whole - 1}) {
      const rlimit limited{room, old.rlim_max};
      setrlimit(RLIMIT_FSIZE, &limited);
      EXPECT_THROW(write_film(path(), format, 60), WorkError) << room;
      setrlimit(RLIMIT_FSIZE, &old);
      EXPECT_TRUE(folder_is_empty()) << room;
    }
  }
  std::signal(SIGXFSZ, before);
}

TEST(Yuv420, IsWithinOneLevelOfBt709) {
  Image image(514, 6);  // wider than the converter's blocks
  std::uint32_t state = 1;
  for (auto& byte : image.rgba) byte = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
  std::vector<std::uint8_t> y(514 * 6), cb(257 * 3), cr(257 * 3);
  yuv420_from_rgba(image, {y.data(), cb.data(), cr.data(), 514, 257, 257});
  for (int v = 0; v < 6; v += 2) {
    for (int u = 0; u < 514; u += 2) {
      double r = 0, g = 0, b = 0;
      for (const auto& [i, j] : {std::pair{u, v}, {u + 1, v}, {u, v + 1}, {u + 1, v + 1}}) {
        const std::uint8_t* p = image.row(j) + 4 * i;
        EXPECT_NEAR(y[static_cast<std::size_t>(j * 514 + i)],
                    16 + 219 * (0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]) / 255, 0.51);
        r += p[0] / 4.0, g += p[1] / 4.0, b += p[2] / 4.0;
      }
      const double luma = 0.2126 * r + 0.7152 * g + 0.0722 * b;
      const auto at = static_cast<std::size_t>(v / 2 * 257 + u / 2);
      EXPECT_NEAR(cb[at], 128 + 224 * (b - luma) / 1.8556 / 255, 0.51);
      EXPECT_NEAR(cr[at], 128 + 224 * (r - luma) / 1.5748 / 255, 0.51);
    }
  }
}

}  // namespace
}  // namespace tumble::io
