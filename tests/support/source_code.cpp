#include "tests/support/source_code.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace understory {
namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// Comments, quoted text and preprocessor lines become spaces; lines stay where they are.
std::string code_alone(std::string text) {
  const auto blank = [&](std::size_t from, std::size_t to) {
    std::replace_if(
        text.begin() + from, text.begin() + std::min(to, text.size()), [](char c) { return c != '\n'; }, ' ');
    return to;
  };
  const auto end_of = [&](const std::string& mark, std::size_t from) {
    const std::size_t at = text.find(mark, from);
    return at == std::string::npos ? text.size() : at + mark.size();
  };
  bool line_is_empty = true;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const bool after_word = i > 0 && is_word(text[i - 1]);
    if (c == '#' && line_is_empty) {
      std::size_t end = text.find('\n', i);
      while (end != std::string::npos && text[end - 1] == '\\') end = text.find('\n', end + 1);
      i = blank(i, end == std::string::npos ? text.size() : end);
    } else if (text.compare(i, 2, "//") == 0) {
      i = blank(i, end_of("\n", i) - 1);
    } else if (text.compare(i, 2, "/*") == 0) {
      i = blank(i, end_of("*/", i + 2));
    } else if (text.compare(i, 2, "R\"") == 0 && !after_word) {
      const std::size_t open = text.find('(', i);
      i = blank(i, end_of(')' + text.substr(i + 2, open - i - 2) + '"', open));
    } else if (c == '"' || (c == '\'' && !after_word)) {  // after a word it separates digits
      std::size_t end = i + 1;
      while (end < text.size() && text[end] != c) end += text[end] == '\\' ? 2 : 1;
      i = blank(i, end + 1);
    } else {
      line_is_empty = c == '\n' || (line_is_empty && c == ' ');
      ++i;
    }
  }
  return text;
}

struct Word {
  std::string text;
  int line;
};

std::vector<Word> words_of(const std::string& code) {
  std::vector<Word> words;
  int line = 1;
  for (std::size_t i = 0; i < code.size();) {
    std::size_t end = i + 1;
    if (is_word(code[i])) {
      while (end < code.size() && (is_word(code[end]) || code[end] == '\'')) ++end;
    } else if (code.compare(i, 2, "::") == 0) {
      end = i + 2;
    }
    if (code[i] == '\n') ++line;
    if (!std::isspace(static_cast<unsigned char>(code[i]))) words.push_back({code.substr(i, end - i), line});
    i = end;
  }
  return words;
}

enum class Brace { scope, anonymous, function, list };

struct Block {
  Brace kind;
  std::string name;  ///< of a scope: of the namespace or type; of a function: its own
  int first_line;
  int open_parentheses;  ///< of the statement around it
};

/// Walks the words of a file and keeps account of what each brace opens.
class Walk {
 public:
  explicit Walk(SourceFile& file) : file_(file) {}

  void take(const Word& word) {
    if (word.text == "{") {
      open(word);
    } else if (word.text == "}") {
      close(word);
    } else if (word.text == ";" && parentheses_ == 0) {
      statement_.clear();
    } else if (word.text == ":" && statement_.size() == 1 && is_access(statement_[0].text)) {
      statement_.clear();
    } else {
      if (word.text == "(") ++parentheses_;
      if (word.text == ")") --parentheses_;
      statement_.push_back(word);
    }
  }

  bool finished() const { return blocks_.empty(); }

 private:
  static bool is_access(const std::string& word) {
    return word == "public" || word == "private" || word == "protected";
  }

  bool in_code() const {
    return !blocks_.empty() && (blocks_.back().kind == Brace::function || blocks_.back().kind == Brace::list);
  }

  bool has(const std::string& text) const {
    return std::any_of(statement_.begin(), statement_.end(),
                       [&](const Word& word) { return word.text == text; });
  }

  /// The first word after a template's parameters.
  std::size_t after_template() const {
    std::size_t i = 0;
    while (i + 1 < statement_.size() && statement_[i].text == "template") {
      int depth = 0;
      do {
        ++i;
        depth += statement_[i].text == "<" ? 1 : statement_[i].text == ">" ? -1 : 0;
      } while (depth > 0 && i + 1 < statement_.size());
      ++i;
    }
    return i;
  }

  /// Joined words from one on, to the one that ends a name.
  std::string name_from(std::size_t i) const {
    std::string name;
    for (; i < statement_.size(); ++i) {
      const std::string& word = statement_[i].text;
      if (word == ":" || word == "final") break;
      if (word != "class" && word != "struct") name += word;
    }
    return name;
  }

  std::string function_name() const {
    std::string name = "?";
    for (const Word& word : statement_) {
      if (word.text == "(") break;
      name = word.text;
    }
    return name;
  }

  /// `: a_{1}` before a constructor's body.
  bool is_member_initialiser() const {
    const auto colon =
        std::find_if(statement_.begin(), statement_.end(), [](const Word& w) { return w.text == ":"; });
    return colon != statement_.begin() && colon != statement_.end() && has("(") &&
           is_word(statement_.back().text[0]);
  }

  void open(const Word& word) {
    Block block{Brace::list, "", statement_.empty() ? word.line : statement_.front().line, parentheses_};
    const std::size_t first = after_template();
    const std::string keyword = first < statement_.size() ? statement_[first].text : "";
    if (in_code() || parentheses_ > 0) {
      block.kind = Brace::list;
    } else if (has("namespace")) {
      const std::string name = name_from(keyword == "inline" ? first + 2 : first + 1);
      block.kind = name.empty() ? Brace::anonymous : Brace::scope;
      block.name = name;
    } else if (keyword == "struct" || keyword == "class" || keyword == "union" || keyword == "enum") {
      block.kind = Brace::scope;
      block.name = name_from(first + 1);
      keep_type(block.name);
    } else if (keyword == "extern" && statement_.size() == 1) {
      block.kind = Brace::scope;
    } else if (has("(") && !is_member_initialiser()) {
      block.kind = Brace::function;
      block.name = function_name();
    }
    blocks_.push_back(block);
    if (block.kind != Brace::list) statement_.clear();
    parentheses_ = 0;
  }

  void close(const Word& word) {
    if (blocks_.empty()) throw std::runtime_error(file_.path + ": a brace too many");
    const Block block = blocks_.back();
    blocks_.pop_back();
    parentheses_ = block.open_parentheses;
    if (block.kind == Brace::function)
      file_.functions.push_back({block.name, word.line - block.first_line + 1});
    if (block.kind != Brace::list || in_code()) {
      statement_.clear();
    } else {
      statement_.push_back(word);
    }
  }

  void keep_type(const std::string& name) {
    std::string qualified;
    for (const Block& block : blocks_) {
      if (block.kind == Brace::anonymous) return;
      if (!block.name.empty()) qualified += block.name + "::";
    }
    if (!name.empty()) file_.types.push_back(qualified + name);
  }

  SourceFile& file_;
  std::vector<Block> blocks_;
  std::vector<Word> statement_;
  int parentheses_ = 0;
};

/// `#include <x>` or "x": x.
std::vector<std::string> includes_of(std::istream& text) {
  std::vector<std::string> includes;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    std::string directive, header;
    words >> directive;
    if (directive == "#") words >> directive, directive.insert(directive.begin(), '#');
    if (directive == "#include" && words >> header && header.size() > 2) {
      includes.push_back(header.substr(1, header.size() - 2));
    }
  }
  return includes;
}

}  // namespace

SourceFile read_source_file(const std::filesystem::path& root, const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::stringstream text;
  text << stream.rdbuf();
  SourceFile source;
  source.path = file.lexically_relative(root).generic_string();
  const std::string content = text.str();
  source.lines = static_cast<int>(std::count(content.begin(), content.end(), '\n'));
  source.includes = includes_of(text);
  Walk walk(source);
  for (const Word& word : words_of(code_alone(content))) walk.take(word);
  if (!walk.finished()) throw std::runtime_error(source.path + ": a brace is not closed");
  return source;
}

std::vector<SourceFile> read_source_files(const std::filesystem::path& root, const std::string& folder) {
  std::vector<SourceFile> files;
  if (!std::filesystem::exists(root / folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".hpp" || extension == ".cpp" || extension == ".h") {
      files.push_back(read_source_file(root, entry.path()));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace understory
