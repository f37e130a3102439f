# Reads apt sources of both formats (one-line *.list, deb822 *.sources) and prints deb822 stanzas
# for another suite or other components of the same repositories, with every option kept.
#
#   from        the suite to derive from; with `to` empty also from-updates, from-security, ...
#   to          the suite to write; empty: the suites that are there
#   components  the components to write; empty: those that are there
#   official    URIs (with a final slash) of the distribution itself; third parties use its suite
#               names too, and have no such suites

function is_official(uri) {
    sub(/\/*$/, "/", uri)
    return index(" " official " ", " " uri " ") > 0
}

# The words of `list` that name the wanted suite, or "".
function wanted_suites(list,    words, n, i, out) {
    n = split(list, words)
    for (i = 1; i <= n; i++)
        if (words[i] == from || (to == "" && index(words[i], from "-") == 1))
            out = out (out == "" ? "" : " ") words[i]
    return out
}

function official_uris(list,    words, n, i, out) {
    n = split(list, words)
    for (i = 1; i <= n; i++)
        if (is_official(words[i]))
            out = out (out == "" ? "" : " ") words[i]
    return out
}

function emit(uris, suites, parts, options,    stanza) {
    uris = official_uris(uris)
    suites = wanted_suites(suites)
    if (uris == "" || suites == "" || index(" " parts " ", " main ") == 0)
        return
    stanza = "Types: deb\nURIs: " uris "\nSuites: " (to == "" ? suites : to) \
        "\nComponents: " (components == "" ? parts : components) "\n" options
    if (!(stanza in seen))
        print stanza
    seen[stanza] = 1
}

function finish_stanza() {
    if (index(" " value["types"] " ", " deb ") && tolower(value["enabled"]) !~ /^(no|false|0|off)$/)
        emit(value["uris"], value["suites"], value["components"], kept)
    delete value
    kept = ""
    field = ""
}

FNR == 1 && NR > 1 { finish_stanza() }

# one-line: deb [option=a,b option=c] uri suite component...
FILENAME !~ /\.sources$/ {
    sub(/#.*/, "")
    if ($1 != "deb")
        next
    line = $0
    options = ""
    sub(/^[ \t]*deb[ \t]+/, "", line)
    if (match(line, /^\[[^]]*\][ \t]*/)) {
        bracket = substr(line, RSTART + 1, RLENGTH)
        line = substr(line, RSTART + RLENGTH)
        sub(/\].*/, "", bracket)
        n = split(bracket, pairs)
        for (i = 1; i <= n; i++) {
            name = tolower(substr(pairs[i], 1, index(pairs[i], "=") - 1))
            text = substr(pairs[i], index(pairs[i], "=") + 1)
            if (name == "arch")
                name = "architectures"
            else if (name == "lang")
                name = "languages"
            else if (name == "target")
                name = "targets"
            gsub(/,/, " ", text)
            options = options name ": " text "\n"
        }
    }
    n = split(line, words)
    parts = ""
    for (i = 3; i <= n; i++)
        parts = parts (i == 3 ? "" : " ") words[i]
    emit(words[1], words[2], parts, options)
    next
}

/^#/ { next }
/^[ \t]*$/ { finish_stanza(); next }
/^[ \t]/ {
    if (field ~ /^(types|uris|suites|components|enabled)$/)
        value[field] = value[field] " " $0
    else
        kept = kept $0 "\n"
    next
}
{
    field = tolower(substr($0, 1, index($0, ":") - 1))
    text = substr($0, index($0, ":") + 1)
    gsub(/^[ \t]+|[ \t]+$/, "", text)
    if (field ~ /^(types|uris|suites|components|enabled)$/)
        value[field] = text
    else if (field !~ /^(description|x-.*)$/)
        kept = kept $0 "\n"
}
END { finish_stanza() }
