// A .NET client of `cc67 serve`, which speaks the protocol from its description alone (host-protocol.md section 8, wire.md section 7):
// `Client PLACE`, where PLACE is `pipe:NAME` on Windows, or `tcp:PORT`. The server has the program `a.c` that `.ci/net` writes.
using System;
using System.Collections.Generic;
using System.IO;
using System.IO.Pipes;
using System.Net.Sockets;
using System.Text;

/// A controller with the calls of the vendor's .NET interface.
class Controller : IDisposable
{
    enum Call { WriteLineReadLine, WriteLine, WriteLineWithEcho, ReadLineTimeOut, ListLocations, Failed, Disconnect,
                FirmwareVersion, CheckForReady, Lock, Location, LockRecovery, ReleaseToken, ServiceConsole, SetConsole }

    readonly Stream stream;
    readonly bool hasLengths;
    public event Action<string> Messages = delegate { };

    public Controller(string place)
    {
        if (place.StartsWith("tcp:")) {
            hasLengths = true;
            stream = new TcpClient("127.0.0.1", int.Parse(place.Substring(4))) { NoDelay = true }.GetStream();
        } else {
            var pipe = new NamedPipeClientStream(".", place.Substring(5), PipeDirection.InOut);
            pipe.Connect(10000);
            stream = pipe;
        }
    }

    public void Dispose() { stream.Dispose(); }

    public string WriteLineReadLine(string line)
    {
        string answer;
        if (Ask(Call.WriteLineReadLine, Text(line), out answer) != 0) throw new IOException("no answer to " + line);
        return answer;
    }

    public void WriteLine(string line) { Expect(0, Ask(Call.WriteLine, Text(line)), line); }
    public string ReadLineTimeOut(int milliseconds)
    {
        string line;
        return Ask(Call.ReadLineTimeOut, BitConverter.GetBytes(milliseconds), out line) == 0 ? line.TrimEnd('\r', '\n') : null;
    }
    public bool WaitToken(string caller) { return Ask(Call.Lock, Text(caller)) == 0; }
    public void ReleaseToken() { Expect(0, Ask(Call.ReleaseToken, new byte[0]), "the token is released"); }
    public int FirmwareVersion() { return Ask(Call.FirmwareVersion, new byte[0]); }
    public int Location() { return Ask(Call.Location, new byte[0]); }
    public void ServiceConsole() { Expect(0, Ask(Call.ServiceConsole, new byte[0]), "the console is served"); }
    public void SetConsole() { Expect(0, Ask(Call.SetConsole, new byte[0]), "the console is registered"); }

    static byte[] Text(string text) { return Encoding.ASCII.GetBytes(text + "\0"); }
    static void Expect(int result, int got, string what) { if (got != result) throw new IOException(what + ": " + got); }
    int Ask(Call call, byte[] arguments) { string data; return Ask(call, arguments, out data); }

    int Ask(Call call, byte[] arguments, out string data)
    {
        var request = new MemoryStream();
        var writer = new BinaryWriter(request);
        if (hasLengths) writer.Write((ushort)(8 + arguments.Length));
        writer.Write((int)call);
        writer.Write(0);
        writer.Write(arguments);
        stream.Write(request.ToArray(), 0, (int)request.Length);
        for (;;) {
            var message = Receive();
            if (message[0] == 0) {
                data = Encoding.ASCII.GetString(message, 5, message.Length - 5).TrimEnd('\0');
                return BitConverter.ToInt32(message, 1);
            }
            Messages(Encoding.ASCII.GetString(message, 1, message.Length - 1).TrimEnd('\0', '\r', '\n'));
            stream.Write(new byte[] { 0xAA }, 0, 1);
        }
    }

    byte[] Receive()
    {
        if (hasLengths) return Exactly(BitConverter.ToUInt16(Exactly(2), 0));
        // One read of a pipe takes what is there: a message, as the server waits for an answer to each.
        var bytes = new byte[2561];
        int count = stream.Read(bytes, 0, bytes.Length);
        if (count == 0) throw new EndOfStreamException();
        Array.Resize(ref bytes, count);
        return bytes;
    }

    byte[] Exactly(int length)
    {
        var bytes = new byte[length];
        for (int have = 0; have < length;) {
            int count = stream.Read(bytes, have, length - have);
            if (count == 0) throw new EndOfStreamException();
            have += count;
        }
        return bytes;
    }
}

static class Program
{
    static int failed, passed;

    static void Check(string name, bool holds)
    {
        Console.WriteLine("{0} {1}", holds ? "ok" : "FAILED", name);
        if (holds) passed++; else failed++;
    }

    static int Main(string[] words)
    {
        using (var board = new Controller(words[0]))
        using (var other = new Controller(words[0])) {
            var console = new List<string>();
            board.Messages += console.Add;
            board.SetConsole();
            for (int call = 0; call < 100 && console.Count < 2; call++) board.ServiceConsole();
            Check("the call-back has the console", console.Count == 2 && console[0] == "hello" && console[1] == "from C");
            Check("the board has a version", board.WriteLineReadLine("Version").StartsWith("KFLOP 4.34"));
            Check("the firmware has a generation", board.FirmwareVersion() == 2);
            Check("the board has a location", board.Location() > 0);
            Check("the token is taken once", board.WaitToken("a test") && !other.WaitToken("another"));
            board.ReleaseToken();
            Check("a token that is free is taken", other.WaitToken("another"));
            other.ReleaseToken();
            board.WriteLine("SetPersistDec 7 67");
            Check("a variable has the value of another client", other.WriteLineReadLine("GetPersistDec 7") == "67");
            board.WriteLine("EnableAxisDest0 0");
            board.WriteLine("Move0=1000");
            while (board.WriteLineReadLine("CheckDone0") != "1") { }
            Check("an axis moves", board.WriteLineReadLine("Dest0").Contains("1000"));
            board.WriteLine("GetGatherHex 0 9");
            string first = board.ReadLineTimeOut(100), second = board.ReadLineTimeOut(100);
            Check("an answer of several lines is read line by line", first.Length == 8 * 9 - 1 && second == "00000000");
            Check("a line that does not come takes its time", board.ReadLineTimeOut(50) == null);
            Exception refused = null;
            try { board.WriteLineReadLine("bogus"); } catch (IOException error) { refused = error; }
            Check("a line without an answer is an exception", refused != null && board.WriteLineReadLine("GetPersistDec 7") == "67");
        }
        Console.WriteLine("{0} passed, {1} failed", passed, failed);
        return failed == 0 ? 0 : 1;
    }
}
