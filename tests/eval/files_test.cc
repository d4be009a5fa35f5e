// Small readers and writers of the eval room.
#include <gtest/gtest.h>

#include <cmath>

#include "eval/files/base64.h"
#include "eval/files/csv_table.h"
#include "eval/files/hash.h"
#include "eval/report/web_assets.h"
#include "mapper/core/error.h"
#include "mapper/io/file.h"
#include "tests/scratch.h"

namespace depthgrid {
namespace {

TEST(Base64, TestVectorsOfRfc4648) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foob"), "Zm9vYg==");
  EXPECT_EQ(Base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xfe"), "//4=");
}

TEST(ContentHash, EveryByteAndTheOrderMatter) {
  const auto hash_of = [](const std::string& text) {
    ContentHash hash;
    hash.Text(text);
    return hash.value();
  };
  const std::string text = "twenty-three bytes long";
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string other = text;
      other[i] = static_cast<char>(other[i] ^ (1 << bit));
      EXPECT_NE(hash_of(other), hash_of(text));
    }
  }
  EXPECT_NE(hash_of("abcdefghABCDEFGH"), hash_of("ABCDEFGHabcdefgh"));
  EXPECT_NE(hash_of(std::string(8, '\0')), hash_of(std::string(16, '\0')));
  EXPECT_NE(hash_of(""), hash_of(std::string(1, '\0')));
}

class CsvTest : public ::testing::Test {
 protected:
  CsvTable Read(const std::string& text) const {
    WriteFile(path_, text);
    return ReadCsv(path_);
  }
  void TearDown() override { std::remove(path_.c_str()); }
  std::string path_ = ScratchPath() + ".csv";
};

TEST_F(CsvTest, ReadsColumnsByName) {
  const CsvTable table = Read("a,b\n1,2.5\n-3e-2,\n");
  EXPECT_EQ(table.rows, 2U);
  EXPECT_EQ(table.Column("a"), (std::vector<double>{1, -0.03}));
  EXPECT_TRUE(std::isnan(table.Column("b")[1]));
  EXPECT_THROW(table.Column("c"), InputError);
}

TEST_F(CsvTest, DamageIsAnError) {
  EXPECT_THROW(Read(""), InputError);
  EXPECT_THROW(Read("a,b\n1\n"), InputError);
  EXPECT_THROW(Read("a,b\n1,x\n"), InputError);
}

TEST(FillPage, NothingEndsAScriptEarly) {
  const std::string page = FillPage("run.html", "a <b> & c", R"({"x":"</script><!-- "})");
  EXPECT_NE(page.find("<title>a &lt;b> &amp; c"), std::string::npos);
  EXPECT_NE(page.find(R"({"x":"<\/script><\u0021-- "})"), std::string::npos);
  std::size_t opened = 0;
  std::size_t closed = 0;
  for (std::size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) ++opened;
  for (std::size_t at = 0; (at = page.find("</script", at)) != std::string::npos; ++at) ++closed;
  EXPECT_EQ(opened, closed);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  // The page opens offline: no address but SVG's namespace, which is a name.
  for (std::size_t at = 0; (at = page.find("http://", at)) != std::string::npos; ++at) {
    EXPECT_EQ(page.substr(at, 27), "http://www.w3.org/2000/svg\"");
  }
}

}  // namespace
}  // namespace depthgrid
