//! WGSL as a list of tokens, and walks along it.

/// What a token is; its text is beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Space,
    Comment,
    Word,
    Number,
    Sign,
}

pub(super) type Token<'a> = (Kind, &'a str);

/// All tokens of a text, which they are one after the other.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut out = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let (kind, length) = match first {
            c if c.is_whitespace() => (Kind::Space, span(rest, char::is_whitespace)),
            '/' if rest.starts_with("//") => (Kind::Comment, span(rest, |c| c != '\n')),
            '0'..='9' => (Kind::Number, number(rest)),
            c if word(c) => (Kind::Word, span(rest, word)),
            '-' if rest.starts_with("->") => (Kind::Sign, 2),
            c => (Kind::Sign, c.len_utf8()),
        };
        let (token, after) = rest.split_at(length);
        out.push((kind, token));
        rest = after;
    }
    out
}

fn span(text: &str, belongs: impl Fn(char) -> bool) -> usize {
    text.find(|c| !belongs(c)).unwrap_or(text.len())
}

/// Digits, point and exponent.
fn number(text: &str) -> usize {
    let mantissa = span(text, |c| c.is_ascii_digit() || c == '.');
    let Some(power) = text[mantissa..].strip_prefix('e') else { return mantissa };
    let sign = usize::from(power.starts_with(['-', '+']));
    mantissa + 1 + sign + span(&power[sign..], |c| c.is_ascii_digit())
}

/// Index of the bracket that closes the one at `open`; none where none does.
pub(super) fn closing(tokens: &[Token], open: usize) -> Option<usize> {
    let (begin, end) = match tokens[open].1 {
        "(" => ("(", ")"),
        "<" => ("<", ">"),
        _ => ("{", "}"),
    };
    let mut depth = 0;
    for (k, token) in tokens.iter().enumerate().skip(open) {
        depth += i32::from(token.1 == begin) - i32::from(token.1 == end);
        if depth == 0 {
            return Some(k);
        }
    }
    None
}

/// Index of the first token from `at` on that is neither space nor comment.
pub(super) fn next(tokens: &[Token], at: usize) -> usize {
    let rest = tokens.iter().skip(at);
    at + rest.take_while(|t| matches!(t.0, Kind::Space | Kind::Comment)).count()
}

/// The parts between commas that stand in no bracket.
pub(super) fn split<'t, 'a>(tokens: &'t [Token<'a>]) -> Vec<&'t [Token<'a>]> {
    let (mut out, mut from, mut at) = (Vec::new(), 0, 0);
    while at < tokens.len() {
        match tokens[at].1 {
            "(" | "{" => at = closing(tokens, at).unwrap_or(at),
            // Of a type; a comparison has space before it.
            "<" if at > 0 && tokens[at - 1].0 == Kind::Word => at = closing(tokens, at).unwrap_or(at),
            "," => {
                out.push(&tokens[from..at]);
                from = at + 1;
            }
            _ => {}
        }
        at += 1;
    }
    out.push(&tokens[from..]);
    out
}

/// Tokens as they were.
pub(super) fn text(tokens: &[Token]) -> String {
    tokens.iter().map(|t| t.1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A text is its tokens, numbers stay whole with their exponents, and an arrow is no minus.
    #[test]
    fn a_text_is_its_tokens() {
        let source = "fn f(a: array<vec4f, 3>) -> f32 { // 1-2\n    return -1.5e-7-a[0].x*2; }";
        let found = tokens(source);
        assert_eq!(text(&found), source);
        for whole in ["1.5e-7", "->", "// 1-2", "2", "vec4f"] {
            assert!(found.iter().any(|t| t.1 == whole), "{whole}");
        }
    }

    /// Commas of a type and of a call inside are none of the list's.
    #[test]
    fn lists_are_split_at_their_own_commas() {
        let source = tokens("a: array<vec4f, 3>, b < c, f(x, y)");
        let parts: Vec<String> = split(&source).into_iter().map(|p| text(p).trim().to_string()).collect();
        assert_eq!(parts, ["a: array<vec4f, 3>", "b < c", "f(x, y)"]);
    }
}
