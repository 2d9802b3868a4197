//! A file manager's part of drag and drop (X11's XDND, version 5), without one.

use std::path::Path;
use std::time::{Duration, Instant};
use x11rb::connection::Connection;
use x11rb::protocol::Event;
use x11rb::protocol::xproto::*;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

/// Drops a folder on a window and returns once the window says that it has taken it.
pub fn drop_on(display: &str, window: Window, folder: &Path) {
    let (server, screen) = RustConnection::connect(Some(display)).unwrap();
    let atom = |name: &str| server.intern_atom(false, name.as_bytes()).unwrap().reply().unwrap().atom;
    let source = server.generate_id().unwrap();
    let root = server.setup().roots[screen].root;
    let (class, none) = (WindowClass::INPUT_ONLY, CreateWindowAux::new());
    server.create_window(0, source, root, 0, 0, 1, 1, 0, class, 0, &none).unwrap();
    server.set_selection_owner(source, atom("XdndSelection"), x11rb::CURRENT_TIME).unwrap();
    let send = |kind: &str, data: [u32; 5]| {
        let message = ClientMessageEvent::new(32, window, atom(kind), data);
        server.send_event(false, window, EventMask::NO_EVENT, message).unwrap();
        server.flush().unwrap();
    };
    send("XdndEnter", [source, 5 << 24, atom("text/uri-list"), 0, 0]);
    send("XdndPosition", [source, 0, 10 << 16 | 10, x11rb::CURRENT_TIME, atom("XdndActionCopy")]);
    let (mut accepted, mut told) = (false, false);
    let start = Instant::now();
    loop {
        match server.poll_for_event().unwrap() {
            Some(Event::SelectionRequest(request)) => {
                let list = format!("file://{}\r\n", folder.display());
                answer(&server, &request, list.as_bytes());
                told = true;
            }
            Some(Event::ClientMessage(m)) if m.type_ == atom("XdndStatus") => {
                accepted = m.data.as_data32()[1] & 1 == 1;
                assert!(accepted, "the window takes no files");
            }
            Some(Event::ClientMessage(m)) if m.type_ == atom("XdndFinished") => return,
            Some(_) => continue,
            None => std::thread::sleep(Duration::from_millis(5)),
        }
        if accepted && told {
            send("XdndDrop", [source, 0, x11rb::CURRENT_TIME, 0, 0]);
            (accepted, told) = (false, false);
        }
        assert!(start.elapsed() < Duration::from_secs(600), "the window does not answer");
    }
}

/// Gives a window the list of files that it asks for.
fn answer(server: &RustConnection, request: &SelectionRequestEvent, list: &[u8]) {
    let SelectionRequestEvent { requestor, property, target, selection, time, .. } = *request;
    server.change_property8(PropMode::REPLACE, requestor, property, target, list).unwrap();
    let response_type = SELECTION_NOTIFY_EVENT;
    let notice =
        SelectionNotifyEvent { response_type, sequence: 0, time, requestor, selection, target, property };
    server.send_event(false, requestor, EventMask::NO_EVENT, notice).unwrap();
    server.flush().unwrap();
}
