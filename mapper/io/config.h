// Option structs from YAML and back (mapper/core/options.h). Every key of a file must be known: an
// unknown one is an error that names the nearest known key, with file and line. The nearest key is
// one that ends in the same word anywhere, else the nearest one of the same group, else the nearest
// word.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/core/options.h"

namespace depthgrid {

struct ConfigEntry;

namespace internal {
std::unique_ptr<OptionsVisitor> MakeYamlWriter(std::string& out);
std::unique_ptr<OptionsVisitor> MakeKeyLister(std::string& out);
std::unique_ptr<OptionsVisitor> MakeKeyPathLister(std::vector<std::string>& out);
std::unique_ptr<OptionsVisitor> MakeValueFinder(const std::string& key_path, std::string& out);
std::unique_ptr<OptionsVisitor> MakeWholeFinder(const std::string& key_path, bool& is_whole);
}  // namespace internal

// The path of every key, "mapper.fusion.gain", in the order the structs declare them.
template <typename Options>
std::vector<std::string> KeyPathsOf(Options options) {
  std::vector<std::string> out;
  options.Visit(*internal::MakeKeyPathLister(out));
  return out;
}

// The value of one key as ListKeys shows it; empty when there is no such key.
template <typename Options>
std::string ValueOf(Options options, const std::string& key_path) {
  std::string value;
  options.Visit(*internal::MakeValueFinder(key_path, value));
  return value;
}

// Whether a key takes whole numbers only; false when there is no such key.
template <typename Options>
bool IsWholeNumber(Options options, const std::string& key_path) {
  bool is_whole = false;
  options.Visit(*internal::MakeWholeFinder(key_path, is_whole));
  return is_whole;
}

class Config {
 public:
  // An empty tree: everything keeps its default.
  Config();
  // Throws InputError for an unreadable, empty or malformed file, or one whose root is not a map.
  static Config FromFile(const std::string& path);
  // `place` names the text in errors.
  static Config FromText(const std::string& text, const std::string& place);

  Config(Config&&) noexcept;
  Config& operator=(Config&&) noexcept;
  Config(const Config&);
  Config& operator=(const Config&);
  ~Config();

  // Overrides one key: "mapper.fusion.gain=0.5"; the value is YAML. Throws InputError if an earlier
  // assignment set the same key.
  void Set(const std::string& assignment);
  // The same with separate key and YAML value, for sweeps. Errors name `place`, or the assignment
  // if it is empty.
  void Set(const std::string& key_path, const std::string& yaml_value,
           const std::string& place = "");
  // Removes a top-level key (dots are part of its name) and returns its subtree; an empty tree if
  // absent. Errors name the subtree's keys by their whole path in the file.
  Config Take(const std::string& key);
  // Removes a top-level key (dots are part of its name) whose value is a list of maps and returns
  // them in order; none if absent.
  std::vector<Config> TakeMaps(const std::string& key);
  // Names what this tree describes, such as "trajectory 'tour'". Errors then give it after file and
  // line, and keys relative to it.
  void NameSubject(const std::string& subject);
  bool Has(const std::string& key_path) const;
  bool HasList(const std::string& key_path) const;
  // A copy with only these top-level keys: for files of other programs, which may have further
  // keys.
  Config Only(const std::vector<std::string>& keys) const;
  // The file (and line) of this tree, for errors.
  std::string Place() const;
  // The file and line of one key, or the assignment that set it.
  std::string PlaceOfKey(const std::string& key_path) const;
  // Names of the top-level keys in file order.
  std::vector<std::string> Keys() const;
  // Every top-level key as written (dots are part of its name) with its value, in file order.
  std::vector<ConfigEntry> Entries() const;
  // The YAML texts of a list's elements at a key path; a scalar is a list of one. Throws InputError
  // if absent.
  std::vector<std::string> List(const std::string& key_path) const;
  // The text at a key path, `otherwise` if there is no such key. Throws InputError for a list or a
  // map.
  std::string Text(const std::string& key_path, const std::string& otherwise = "") const;
  // The texts of a list; a single text is a list of one, an absent key an empty list.
  std::vector<std::string> Texts(const std::string& key_path) const;
  // The tree as YAML.
  std::string ToYaml() const;

  // Overwrites the options' fields from the tree; throws InputError for an unknown key, a wrong
  // type or a value out of range. Keys not in the tree keep the value they have.
  template <typename Options>
  void Read(Options& options) const {
    const std::unique_ptr<OptionsVisitor> reader =
        Reader([&options] { return KeyPathsOf(options); });
    options.Visit(*reader);
    FinishReading(*reader);
  }

  struct Tree;

 private:
  explicit Config(std::unique_ptr<Tree> tree);
  // `all_keys` is called for the error message of an unknown key.
  std::unique_ptr<OptionsVisitor> Reader(std::function<std::vector<std::string>()> all_keys) const;
  static void FinishReading(OptionsVisitor& reader);

  std::unique_ptr<Tree> tree_;
};

// The place of the key in the last of these trees that has it; empty if none has.
std::string PlaceOfKey(const std::vector<const Config*>& layers, const std::string& key_path);

struct ConfigEntry {
  std::string key;
  std::string place;                              // file and line, for errors
  std::string text;                               // the value as one line of YAML
  std::optional<Config> map;                      // the value, if it is a map of keys
  std::optional<std::vector<std::string>> items;  // the elements' YAML texts, if it is a list
};

// Every effective key, in the order the structs declare them; reading it back gives the same
// values.
template <typename Options>
std::string ToYaml(Options options) {
  std::string out;
  options.Visit(*internal::MakeYamlWriter(out));
  return out;
}

// One line per key: path, default, allowed values, meaning. For --help and docs.
template <typename Options>
std::string ListKeys(Options options) {
  std::string out;
  options.Visit(*internal::MakeKeyLister(out));
  return out;
}

// The only candidate that begins with `word`, else the one closest to it in edit distance (two
// neighbouring letters swapped are one slip), or "" when more than half of its letters differ.
std::string NearestWord(const std::string& word, const std::vector<std::string>& candidates);

// ", did you mean 'prefixNEAREST'?" for the end of a message, or "" when no candidate is near.
std::string DidYouMean(const std::string& word, const std::vector<std::string>& candidates,
                       const std::string& prefix = "");

// The same for key paths, by their last words: those with the same last word as `key_path` or, if
// there is none and `or_near`, with the nearest last word; at most the three most similar.
std::string DidYouMeanKey(const std::string& key_path, const std::vector<std::string>& key_paths,
                          bool or_near);

}  // namespace depthgrid
