#pragma once
#include <filesystem>
#include <vector>

#include "trials/trial.h"

// Keys and their seals. A seal is the SHA-256 of a key's file, salt included, in the form that sha256sum writes, so
// that anybody can check it: `cd KEYS && sha256sum --check DIR/seals.txt`.
namespace tumble::trials {

inline constexpr const char* kSealsFile = "seals.txt";

std::string key_text(const TrialKey& key);  // JSON
// `name` stands in messages for the file. Throws InputError.
TrialKey parse_key(const std::string& text, const std::string& name);

std::filesystem::path key_path(const std::filesystem::path& keys, const std::string& trial);  // KEYS/0001.json

// All seals of these keys, a line each.
std::string seals_text(const std::vector<TrialKey>& keys);

struct OpenedKey {
  TrialKey key;
  bool sealed = false;  // the key is the one that was published
};
// Opens the key of every line of DIR/seals.txt. Throws InputError where a file is missing or is no key, and where KEYS
// holds a key that was never sealed.
std::vector<OpenedKey> open_keys(const std::filesystem::path& data, const std::filesystem::path& keys);

}  // namespace tumble::trials
