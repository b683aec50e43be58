//! An editor that starts its own debugger and attaches to a board elsewhere: messages are passed on.

use std::io::{self, BufReader, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::mpsc::Receiver;
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

use super::wire::{self, ClientWire};
use crate::debugger::DebugError;

/// The time limit for a board's greeting.
const PATIENCE: Duration = Duration::from_secs(10);

/// A board to which a debugger can attach, after the exchange of greetings.
pub(super) struct RemoteBoard {
    stream: TcpStream,
    input: BufReader<TcpStream>,
    /// The capabilities of its debugger.
    capabilities: Value,
}

/// Connects to the board that an attach request names, and sends it the client's greeting.
pub(super) fn connect(arguments: &Value, greeting: &Value) -> Result<RemoteBoard, DebugError> {
    let address = match (&arguments["address"], &arguments["port"]) {
        (Value::String(address), _) => address.clone(),
        (_, Value::Number(port)) => format!("127.0.0.1:{port}"),
        _ => return Err("\"attach\" takes the \"address\" that `cc67 serve --debug PORT` prints".into()),
    };
    let failed = |error: io::Error| DebugError::from(format!("no board to debug at {address}: {error}"));
    let stream = TcpStream::connect(&address).map_err(failed)?;
    let input = BufReader::new(stream.try_clone().map_err(failed)?);
    let mut board = RemoteBoard { stream, input, capabilities: Value::Null };
    board.stream.set_read_timeout(Some(PATIENCE)).map_err(failed)?;
    wire::write(&mut board.stream, greeting).map_err(failed)?;
    let answer = wire::read(&mut board.input);
    let answer = answer.ok_or_else(|| format!("what answers at {address} is not a board to debug"))?;
    board.capabilities = answer["body"].clone();
    board.stream.set_read_timeout(None).map_err(failed)?;
    Ok(board)
}

/// Passes messages on until one side disconnects; `request` is the first.
pub(super) fn relay<W: Write>(
    board: RemoteBoard,
    requests: Receiver<Value>,
    mut client: ClientWire<W>,
    request: &Value,
) -> io::Result<()> {
    let RemoteBoard { mut stream, mut input, capabilities } = board;
    wire::write(&mut stream, request)?;
    client.event("capabilities", json!({ "capabilities": capabilities }))?;
    thread::spawn(move || {
        while let Ok(request) = requests.recv() {
            if wire::write(&mut stream, &request).is_err() {
                break;
            }
        }
        // This tells the other side that the client has gone; an error means that the stream is already closed.
        let _ = stream.shutdown(Shutdown::Both);
    });
    while let Some(message) = wire::read(&mut input) {
        client.forward(message)?;
    }
    Ok(())
}
