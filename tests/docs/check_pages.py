"""What the pages say exists: code, names, options, files, decisions. Prints TAP.

check_pages.py ROOT [--quotes FILE...] [--programs FILE...]

ROOT is the checkout. --quotes names the files that the build compiles and that blocks of code are
taken from; --programs those whose --help knows the options that pages name.
"""

import os
import re
import subprocess
import sys

PAGE_FOLDERS = ['docs']
PAGES = ['README.md', 'CONTRIBUTING.md']
CODE = ['lib', 'include', 'shaders', 'tools', 'samples', 'tests', 'bench', 'docs', 'scripts']
SKIPPED_FOLDERS = {'.git', 'build', 'subprojects', '__pycache__'}
# How CONTRIBUTING.md writes of names in general.
PLACEHOLDERS = {'sluiceVerbNoun', 'SluiceNoun', 'SLUICE_TYPE_VALUE'}
ENVIRONMENT = re.compile(r'\$\{?(SLUICE_\w+)|getenv\("(SLUICE_\w+)"|\b(SLUICE_\w+)=')
NAME = re.compile(r'\b(?:sluice[A-Z]\w*|Sluice[A-Z]\w*|SLUICE_\w+)')


def read(path):
    with open(path, encoding='utf-8', errors='replace') as file:
        return file.read()


def walk(root, folder):
    for at, folders, files in os.walk(os.path.join(root, folder)):
        folders[:] = sorted(name for name in folders if name not in SKIPPED_FOLDERS)
        for name in sorted(files):
            yield os.path.relpath(os.path.join(at, name), root)


class Page:
    """A Markdown file: blocks of code, and the text around them."""

    def __init__(self, root, path):
        self.path, self.blocks, text, block = path, [], [], None
        self.lines = read(os.path.join(root, path)).splitlines()
        for number, line in enumerate(self.lines, 1):
            fence = re.match(r'\s*```(.*)$', line)
            if fence and block is None:
                block = (number, fence.group(1).strip(), [])
            elif fence:
                self.blocks.append(block)
                block = None
            elif block is not None:
                block[2].append(line)
            else:
                text.append((number, line))
        self.text = text

    def shell_lines(self):
        """Lines of blocks without a language, and of indented blocks."""
        for number, language, lines in self.blocks:
            if language in ('', 'sh'):
                yield from ((number + i + 1, line) for i, line in enumerate(lines))
        yield from ((number, line) for number, line in self.text if line.startswith('    '))

    def spans(self):
        """Inline code, and where it is."""
        for number, line in self.text:
            for span in re.findall(r'`([^`]+)`', line):
                yield number, span


def without_indentation(lines):
    lines = [line.rstrip() for line in lines]
    while lines and not lines[-1]:
        lines.pop()
    indents = [len(line) - len(line.lstrip()) for line in lines if line]
    return [line[min(indents):] for line in lines]


def is_quotation(block, sources):
    wanted = without_indentation(block)
    for source in sources:
        for at in range(len(source) - len(wanted) + 1):
            if without_indentation(source[at:at + len(wanted)]) == wanted:
                return True
    return False


def check_blocks(pages, quotes):
    sources = [read(path).splitlines() for path in quotes]
    known = {'', 'sh', 'c', 'glsl', 'hlsl'}
    for page in pages:
        for number, language, lines in page.blocks:
            if language not in known:
                yield f'{page.path}:{number}: a block in {language}, which nothing checks'
            elif language in ('c', 'glsl', 'hlsl') and not is_quotation(lines, sources):
                yield f'{page.path}:{number}: no compiled file has these lines'


def strip_comments(text):
    return re.sub(r'/\*.*?\*/|//[^\n]*', ' ', text, flags=re.S)


def comments_of(text):
    """Comments with their line numbers."""
    for match in re.finditer(r'/\*.*?\*/|//[^\n]*', text, flags=re.S):
        first = text.count('\n', 0, match.start()) + 1
        for i, line in enumerate(match.group(0).splitlines()):
            yield first + i, line


def public_files(root):
    for folder in ('include/sluice', 'shaders'):
        for path in walk(root, folder):
            if path.endswith(('.h', '.glsl')):
                yield path


def known_names(root):
    """What headers and shaders declare, and what the environment and the preprocessor are asked for."""
    names = set()
    for path in public_files(root):
        names |= set(NAME.findall(strip_comments(read(os.path.join(root, path)))))
    for path in walk(root, 'lib'): # names that a function answers as text
        names |= set(re.findall(r'"(SLUICE_\w+)"', read(os.path.join(root, path))))
    for folder in ('scripts', 'tests', 'samples', 'docs/examples', 'bench'):
        for path in walk(root, folder):
            text = read(os.path.join(root, path)) if path.endswith(('.sh', '.build', '.c')) else ''
            names |= {name for found in ENVIRONMENT.findall(text) for name in found if name}
    return names


def check_names(root, pages):
    names = known_names(root)

    def unknown(line):
        for match in NAME.finditer(line):
            name, rest = match.group(0), line[match.end():match.end() + 3]
            if name in names or name in PLACEHOLDERS:
                continue
            if (name.endswith('_') or rest.startswith(('*', '...', '<', '{'))) and any(
                    other.startswith(name) for other in names):
                continue
            yield name

    for page in pages:
        for number, line in enumerate(page.lines, 1):
            yield from (f'{page.path}:{number}: there is no {name}' for name in unknown(line))
    for path in public_files(root):
        for number, line in comments_of(read(os.path.join(root, path))):
            yield from (f'{path}:{number}: there is no {name}' for name in unknown(line))


def slug(title):
    """The anchor that a page's reader makes of a title."""
    title = re.sub(r'\[([^\]]*)\]\([^)]*\)', r'\1', title).replace('`', '').strip().lower()
    return re.sub(r'[^\w\- ]', '', title).replace(' ', '-')


def anchors_of(path):
    lines = read(path).splitlines()
    return {slug(line.lstrip('#')) for line in lines if re.match(r'#+ ', line)}


def check_links(root, pages):
    for page in pages:
        folder = os.path.dirname(os.path.join(root, page.path))
        for number, line in page.text:
            line = re.sub(r'`[^`]*`', '', line)
            for target in re.findall(r'\]\(([^)\s]+)\)', line):
                if re.match(r'[a-z]+:', target):
                    continue
                path, _, anchor = target.partition('#')
                full = os.path.join(folder, path) if path else os.path.join(root, page.path)
                if not os.path.exists(full):
                    yield f'{page.path}:{number}: there is no {path}'
                elif anchor and full.endswith('.md') and anchor not in anchors_of(full):
                    yield f'{page.path}:{number}: {path or "the page"} has no #{anchor}'


def check_decisions(root):
    """The index of the decisions has a row for each of them."""
    folder = os.path.join(root, 'docs', 'decisions')
    index = read(os.path.join(folder, 'README.md'))
    for name in sorted(os.listdir(folder)):
        if re.match(r'\d{4}-', name) and f'| [{int(name[:4])}]({name}) |' not in index:
            yield f'docs/decisions/README.md: there is no row for {name}'


def expand(name):
    """`{a,b}.c` names two files."""
    match = re.search(r'\{([^{}]*)\}', name)
    if not match:
        return [name]
    return [full for part in match.group(1).split(',')
            for full in expand(name[:match.start()] + part + name[match.end():])]


def check_files(root, pages):
    files = set(path for folder in CODE for path in walk(root, folder)) | set(os.listdir(root))
    folders = {os.path.dirname(path) for path in files}
    by_name = {os.path.basename(path) for path in files}
    source = re.compile(r'[\w./{},*-]+\.(?:c|h|cpp|glsl|comp|sh|md|py)')
    for page in pages:
        for number, span in page.spans():
            for name in span.split():
                if not source.fullmatch(name) or name.startswith(('.', '/')) or '*' in name:
                    continue
                for one in expand(name):
                    top = one.split('/')[0]
                    near = os.path.normpath(os.path.join(os.path.dirname(page.path), one))
                    if '/' not in one and one in by_name or one in files or near in files:
                        continue
                    if any(path.endswith('/' + one) for path in files):
                        continue
                    if '/' in one and top not in CODE and one not in folders and top not in by_name:
                        continue # of a system, or something that a program writes
                    if '/' not in one and not one.endswith(('.c', '.glsl', '.sh', '.py')):
                        continue
                    yield f'{page.path}:{number}: there is no {one}'


SUBCOMMANDS = {'sluice-tradeoff': [['play']]}
OPTION = re.compile(r'(?<![\w-])--[a-z][a-z0-9-]*')


def options_of(programs, root):
    """By program: what its --help names, of scripts also what their text names."""
    options = {}
    for program in programs:
        name = os.path.basename(program)
        options[name] = set()
        for words in [[], *SUBCOMMANDS.get(name, [])]:
            run = subprocess.run([program, *words, '--help'], capture_output=True, text=True, timeout=60, check=False)
            options[name] |= set(OPTION.findall(run.stdout))
    for folder in ('scripts', 'bench', 'tests'):
        for path in walk(root, folder):
            if path.endswith(('.sh', '.py')):
                options.setdefault(os.path.basename(path), set()).update(
                    OPTION.findall(read(os.path.join(root, path))))
    return options


def check_options(root, pages, programs):
    options = options_of(programs, root)
    program = re.compile(r'(?:^|[\s/;|&(])(' + '|'.join(
        re.escape(name) for name in sorted(options, key=len, reverse=True)) + r')(?=$|[\s;|&)])')
    every = set().union(*options.values()) | {'--suite', '--setup', '--whole-archive'} # of meson, of linkers
    # What scripts pass on, behind "--", goes to the program that they start.
    passes_to = {'sluice-tradeoff': 'streaming', 'demo.sh': 'streaming'}
    own = re.compile(r'(?:^|[\s/;|&(])(sluice-[a-z]+)(?=$|[\s;|&)])')
    modules = {'sluice-exr', 'sluice-store', 'sluice-bake', 'sluice-container', 'sluice-vulkan', 'sluice-open', 'sluice-http'}

    def check(where, line):
        for name in own.findall(line):
            if name not in options and name not in modules:
                yield f'{where}: there is no program {name}'
        found = list(program.finditer(line))
        for i, match in enumerate(found):
            name = match.group(1)
            end = found[i + 1].start() if i + 1 < len(found) else len(line)
            words, _, passed = line[match.end():end].partition(' -- ')
            known = options[name] | {'--help'}
            known_passed = options.get(passes_to.get(name, name), set())
            for option in OPTION.findall(words.split(';')[0] if ';' in words and '#' not in words else words):
                if option not in known:
                    yield f'{where}: {name} has no {option}'
            for option in OPTION.findall(passed):
                if known_passed and option not in known_passed | known:
                    yield f'{where}: {passes_to.get(name, name)} has no {option}'

    for page in pages:
        for number, line in page.shell_lines():
            yield from check(f'{page.path}:{number}', line)
        for number, span in page.spans():
            if re.match(r'--[a-z]', span):
                for option in OPTION.findall(span):
                    if option not in every:
                        yield f'{page.path}:{number}: no program has {option}'
            elif program.match(span) or '/' in span.split(' ')[0]:
                yield from check(f'{page.path}:{number}', span)


def main(arguments):
    root, lists, kind = arguments[0], {'--quotes': [], '--programs': []}, None
    for argument in arguments[1:]:
        if argument in lists:
            kind = argument
        else:
            lists[kind].append(argument)
    paths = PAGES + [path for folder in PAGE_FOLDERS for path in walk(root, folder) if path.endswith('.md')]
    pages = [Page(root, path) for path in paths]
    facts = [('blocks_of_code_are_lines_of_compiled_files', check_blocks(pages, lists['--quotes'])),
             ('names_of_the_interface_exist', check_names(root, pages)),
             ('links_lead_somewhere', check_links(root, pages)),
             ('every_decision_is_in_the_index', check_decisions(root)),
             ('named_files_exist', check_files(root, pages)),
             ('programs_have_the_options_that_pages_name', check_options(root, pages, lists['--programs']))]
    failed = False
    print(f'1..{len(facts)}')
    for number, (fact, found) in enumerate(facts, 1):
        found = list(found)
        print(f'{"not ok" if found else "ok"} {number} - {fact}')
        for line in found:
            print('#', line)
        failed = failed or bool(found)
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
