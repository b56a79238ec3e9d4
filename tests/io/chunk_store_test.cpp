#include "io/chunk_store.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

class ChunkStoreTest : public InFolder {};

TEST_F(ChunkStoreTest, GivesBackWhatWasWrittenAndNothingElse) {
  const ChunkStore::Rows rows{{1.5f, -2, 3}, {}, {4}};
  ChunkStore(folder_, "a mill").write(3, rows);
  const ChunkStore again(folder_, "a mill"), other(folder_, "another mill");
  ChunkStore::Rows found;
  ASSERT_TRUE(again.read(3, found));
  EXPECT_EQ(found, rows);
  EXPECT_FALSE(again.read(2, found));
  EXPECT_FALSE(other.read(3, found));
}

TEST_F(ChunkStoreTest, ABrokenChunkIsNoChunk) {
  const ChunkStore store(folder_, "a mill");
  store.write(0, {{1, 2, 3}});
  std::filesystem::resize_file(store.folder() / "00000.h5", 700);
  ChunkStore::Rows found;
  EXPECT_FALSE(store.read(0, found));
  store.write(0, {{1, 2, 3}});
  EXPECT_TRUE(store.read(0, found));
}

TEST_F(ChunkStoreTest, AFolderThatCannotBeIsRefused) {
  write_bytes(folder_ / "file", "x");
  EXPECT_THROW(ChunkStore(folder_ / "file", "a mill"), InputError);
}

}  // namespace
}  // namespace tumble::io
