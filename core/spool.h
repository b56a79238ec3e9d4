#pragma once
#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tumble {

// Bytes appended once and read from anywhere: few stay in memory, many go to an unnamed temporary file (in $TMPDIR),
// which is gone with its owner, however that ends. Throws WorkError where the disk is full.
class ByteSpool {
 public:
  ByteSpool() = default;
  ~ByteSpool();
  ByteSpool(const ByteSpool&) = delete;
  ByteSpool& operator=(const ByteSpool&) = delete;

  void append(const void* bytes, std::size_t count);
  void read(std::size_t from, void* bytes, std::size_t count) const;
  void write(std::size_t from, const void* bytes, std::size_t count);  // over what is there
  std::size_t size() const { return size_; }

 private:
  int file_ = -1;
  std::size_t size_ = 0;
  std::vector<std::byte> memory_;  // all bytes while there is no file
};

// A list of plain rows at a memory that does not grow with it: what long films are full of.
template <typename T>
class Spool {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Spool() : bytes_(std::make_unique<ByteSpool>()) {}
  Spool(std::initializer_list<T> rows) : Spool() { append({rows.begin(), rows.size()}); }
  Spool(const Spool& other) : Spool() {
    other.each_block([this](std::size_t, std::span<T> rows) { append(rows); });
  }
  Spool(Spool&& other) noexcept(false) : Spool() { std::swap(bytes_, other.bytes_); }
  Spool& operator=(Spool other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~Spool() = default;

  void append(std::span<const T> rows) { bytes_->append(rows.data(), rows.size_bytes()); }
  std::size_t size() const { return bytes_->size() / sizeof(T); }
  bool empty() const { return size() == 0; }
  std::vector<T> read(std::size_t first, std::size_t count) const {
    std::vector<T> rows(count);
    bytes_->read(first * sizeof(T), rows.data(), count * sizeof(T));
    return rows;
  }
  T operator[](std::size_t i) const { return read(i, 1).front(); }

  // `use(first, rows)` for all rows, a few thousand at a time.
  template <typename Use>
  void each_block(const Use& use) const {
    for (std::size_t first = 0; first < size(); first += kBlock) {
      std::vector<T> rows = read(first, std::min(kBlock, size() - first));
      use(first, std::span<T>(rows));
    }
  }
  template <typename Change>
  void change(const Change& change) {  // of every row
    each_block([&](std::size_t first, std::span<T> rows) {
      for (T& row : rows) change(row);
      bytes_->write(first * sizeof(T), rows.data(), rows.size_bytes());
    });
  }

  class Iterator {  // forward, once: reads ahead in blocks
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = T;
    using difference_type = std::ptrdiff_t;
    using pointer = const T*;
    using reference = const T&;

    Iterator(const Spool* of, std::size_t at) : of_(of), at_(at) {}
    const T& operator*() {
      if (at_ < first_ || at_ >= first_ + block_.size()) {
        first_ = at_;
        block_ = of_->read(at_, std::min(kBlock, of_->size() - at_));
      }
      return block_[at_ - first_];
    }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const Spool* of_;
    std::size_t at_, first_ = 0;
    std::vector<T> block_;
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size()}; }

 private:
  static constexpr std::size_t kBlock = 4096;  // rows
  std::unique_ptr<ByteSpool> bytes_;
};

// Rows that belong to frames, as many to each as there happen to be.
template <typename T>
class FrameSpool {
 public:
  void append(std::span<const T> frame) {
    rows_.append(frame);
    ends_.push_back(rows_.size());
  }
  std::size_t size() const { return ends_.size(); }
  std::vector<T> operator[](std::size_t frame) const {
    const std::size_t first = frame == 0 ? 0 : ends_[frame - 1];
    return rows_.read(first, ends_[frame] - first);
  }

 private:
  Spool<T> rows_;
  std::vector<std::size_t> ends_;
};

}  // namespace tumble
