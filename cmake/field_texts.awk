# Writes what the comments beside the fields of structs say, as C++, a line a field: what `understory keys` prints.
#   awk -f cmake/field_texts.awk HEADER...
function quoted(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/"/, "\\\"", text)
  return "\"" text "\""
}
function flush() {
  if (name != "") {
    sub(/^ +/, "", meaning)
    printf "    {%s, %s, %s, %s},\n", quoted(owner), quoted(type), quoted(name), quoted(meaning)
  }
  name = ""
  meaning = ""
}
BEGIN {
  print "#include \"scenarios/config/keys.hpp\"\n\nnamespace understory {\n\nextern const std::vector<FieldText>& field_texts();"
  print "const std::vector<FieldText>& field_texts() {\n  static const std::vector<FieldText> texts{"
}
/^struct [A-Za-z]+.*\{$/ {
  owner = $2
  above = code = ""
  next
}
/^};/ {
  flush()
  owner = ""
}
owner == "" || !/^  [ ]*[^ ]/ { next }
{ line = $0; sub(/^ +/, "", line) }
line ~ /^\/\/\/</ {  # goes on with the field's comment
  sub(/^\/\/\/< */, "", line)
  meaning = meaning " " line
  next
}
line ~ /^\/\/\// {  # comes before its field
  flush()
  sub(/^\/\/\/ */, "", line)
  above = above " " line
  next
}
{
  at = index(line, "///<")
  behind = at ? substr(line, at + 4) : ""
  code = code (code == "" ? "" : " ") (at ? substr(line, 1, at - 1) : line)
  if (code !~ /[;}] *$/) {
    if (code ~ /\{ *$/) code = above = ""  # a function
    next
  }
  flush()
  sub(/ *(=|\{).*/, "", code)
  sub(/; *$/, "", code)
  if (code ~ /^const [A-Za-z]+& [a-z_]+\(\) const$/) {  # an accessor gives a struct as a field does
    gsub(/^const |&|\(\) const$/, "", code)
  }
  if (code ~ /^[A-Za-z_:<>,0-9 ]+ [a-z_0-9]+$/ && code !~ /^(return|using|case|break) /) {
    name = type = code
    sub(/.* /, "", name)
    sub(/ [^ ]*$/, "", type)
    sub(/^std::vector</, "", type)
    sub(/>$/, "", type)
    meaning = above behind
  }
  code = above = ""
}
END { print "  };\n  return texts;\n}\n\n}  // namespace understory" }
