//! Which keys the reader knows, noted while it reads: for the test that holds reader and schema together.

use std::cell::RefCell;
use std::collections::BTreeSet;

/// Keys of an object, sorted.
pub type Keys = BTreeSet<String>;

thread_local! {
    static SEEN: RefCell<BTreeSet<Keys>> = const { RefCell::new(BTreeSet::new()) };
}

/// The reader was asked to let only these keys through.
pub fn note(known: &[&str]) {
    SEEN.with_borrow_mut(|seen| seen.insert(known.iter().map(|k| k.to_string()).collect()));
}

/// All lists noted on this thread so far, forgotten here.
pub fn taken() -> BTreeSet<Keys> {
    SEEN.take()
}
