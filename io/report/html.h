#pragma once
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/statistics.h"

// Text for a page. Whatever comes from files and names passes through here, so none of it is ever read as markup.
namespace tumble::io::report {

using Json = nlohmann::ordered_json;

// Valid UTF-8 (what is not is replaced) with & < > " ' escaped: for text and for attributes in quotes.
std::string escaped(const std::string& text);

// JSON that can stand inside <script>: ASCII, and no "<", so nothing in it ends the element.
std::string script_json(const Json& json);

// What stands in a page's <head>: policy, title, styles. `media`: the policy's word on films, "" for none at all.
std::string head_html(const std::string& title, const std::string& media = "");

// What a reader must know first, as a box above the numbers; nothing where there is nothing. And the page's last line.
std::string caveats_html(const std::vector<std::string>& caveats);
std::string footer_html(const std::string& version);

std::string base64(std::string_view bytes);

// A film as an element of the page, with these attributes: by its address, or the file's bytes themselves. Throws
// WorkError where it cannot be read.
std::string video_html_of(const std::string& url, const std::string& attributes);
std::string video_html(const std::filesystem::path& file, const std::string& attributes);

// Puts values where the page says {{name}}. What was put in is not looked at again. A {{name}} without a value, or a
// value without a place, is a mistake of ours: std::logic_error.
std::string filled(std::string_view page, const std::map<std::string, std::string>& values);

// "231.42", with as many digits as the standard error gives meaning to (two of its own); four digits without one.
// An en dash where there is no number.
std::string number(double value, double se = kNotGiven);
// "231.42 ± 0.31"
std::string with_error(const Estimate& estimate);

}  // namespace tumble::io::report
